:- use_module(rule_sets).
:- use_module(explain).
:- use_module(loader).
:- use_module(sketch).
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

test(both_rule_sets_know_the_same_tasks, true(Default == Thesis)) :-
    here(Directory),
    load_rule_set(Directory, default),
    findall(T, ruled_task(default, T), Default0), sort(Default0, Default),
    findall(T, ruled_task(thesis, T), Thesis0), sort(Thesis0, Thesis).
test(files_beside_are_part_of_the_rules, true(Titles == ['default/handles:stem'])) :-
    here(Directory),
    load_rule_set(Directory, default),
    sketch([ box([0, 0, 0.03], [0.24, 0.24, 0.06], []), box([0.2, 0, 0.05], [0.16, 0.03, 0.02], []) ]),
    findall(R, ( proof(default_handles, stem(_, _), Trace), R = Trace.rule ), All),
    sort(All, Titles),
    wipe.
test(held_together) :- held_together(default, v1, cooking).
test(thesis_says_nothing, fail) :- held_together(thesis, v1, cooking).
test(held_if_alone) :- held_if_alone(default, v2, handover).
test(not_every_task, fail) :- held_if_alone(default, v2, cutting).

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
