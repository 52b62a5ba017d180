:- use_module(rule_sets).
:- use_module(loader).
:- use_module(library(plunit)).

here(Directory) :-
    module_property(rule_sets, file(File)),
    file_directory_name(File, Directory).

:- begin_tests(rule_sets, [setup(( here(D), load_rule_set(D, thesis) ))]).

test(tasks, all(T == [cooking, cutting, hammering, handover, pouring, scooping, turning])) :-
    setof(Task, ruled_task(thesis, Task), Tasks),
    member(T, Tasks).
test(affordances, all(A == [contain, cut, grasp, pound, scoop, support, wrap_grasp])) :-
    setof(Affordance, ruled_affordance(thesis, Affordance), Affordances),
    member(A, Affordances).
test(module, true(Module == thesis_version2)) :-
    rule_module(thesis, v2, Module).

%   A file that Prolog only complains about is refused.

test(syntax_error, throws(bad_rules([_]))) :-
    loads(":- module(faulty_a, []).\nrule(X) :- .\n").
test(singleton_variable, throws(bad_rules([_]))) :-
    loads(":- module(faulty_b, []).\nrule(X) :- true.\n").
test(missing_file, throws(bad_rules([_]))) :-
    load_checked('/no/such/file.pl').
test(sound_file) :-
    loads(":- module(sound, []).\nrule(_) :- true.\n").
test(missing_rule_set, throws(bad_rules([_|_]))) :-
    here(Directory),
    load_rule_set(Directory, no_such_set).

loads(Text) :-
    setup_call_cleanup(
        ( tmp_file_stream(File, Stream, [extension(pl), encoding(utf8)]),
          write(Stream, Text),
          close(Stream) ),
        load_checked(File),
        delete_file(File)).

:- end_tests(rule_sets).
