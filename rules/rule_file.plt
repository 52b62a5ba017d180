:- use_module(rule_file).
:- use_module(library(plunit)).

:- begin_tests(rule_file).

predicates(Path) :-
    module_property(rule_file, file(File)),
    file_directory_name(File, Directory),
    atomic_list_concat([Directory, '/predicates.pl'], Path).

checked(Name, Lines, Problems, Rules) :-
    predicates(Path),
    format(string(Start), ":- module(~w, []).~n:- use_module(~q).~n", [Name, Path]),
    atomic_list_concat([Start|Lines], '\n', Text),
    setup_call_cleanup(
        ( tmp_file_stream(File, Stream, [extension(pl), encoding(utf8)]),
          write(Stream, Text), nl(Stream), close(Stream) ),
        rule_file_problems(File, Problems, Rules),
        delete_file(File)).

test(sound, true(Problems-Rules == []-[baking-4])) :-
    checked(rule_file_a, ["affordTask(ID, baking) :- primitive_values(ID, _, D), min_ratio(D, 2)."],
            Problems, Rules).
test(syntax, true(sub_string(Problem, _, _, _, "yntax error"))) :-
    checked(rule_file_b, ["affordTask(ID, baking) :- max_shape(ID."], [Problem], []).
test(singleton, true(sub_string(Problem, _, _, _, "ingleton"))) :-
    checked(rule_file_c, ["affordTask(ID, baking) :- max_shape(ID), X = 1."], [Problem|_], []).
test(unknown_predicate, true(sub_string(Problem, _, _, _, "line 4: the rule for"))) :-
    checked(rule_file_d, ["affordTask(ID, baking) :- primitive_values(ID, _, _), light(ID)."],
            [Problem], _).
test(bound, true(sub_string(Problem, _, _, _, "three numbers"))) :-
    checked(rule_file_e,
            ["partAffordance(ID, a) :- primitive_values(ID, _, D), min_dimension(D, [1])."],
            [Problem], _).
test(no_rule, true(sub_string(Problem, _, _, _, "no rule"))) :-
    checked(rule_file_f, ["something(1)."], [Problem], []).
test(for_anything, true(sub_string(Problem, _, _, _, "does not say which"))) :-
    checked(rule_file_g, ["affordTask(ID, _) :- max_shape(ID)."], [Problem|_], _).
test(no_such_file, true(Problems = [_|_])) :-
    rule_file_problems('/no/such/rules.pl', Problems, _).

:- end_tests(rule_file).
