:- use_module(reading).
:- use_module(predicates).
:- use_module(library(plunit)).

:- begin_tests(reading, [setup(ready)]).

ready :-
    use_module(thesis/version1),
    prepare_rules(thesis_version1, 'thesis/version1'),
    faulty_rules:use_module(predicates),
    faulty_rules:use_module(quantities).

test(unknown_predicates_are_problems, true(sub_string(Problem, _, _, _, "calls no_such/1"))) :-
    assertz(faulty_rules:(affordTask(ID, broken) :- primitive_values(ID, _, _), no_such(ID))),
    prepare_rules(faulty_rules, faulty),
    once(rule_problem(faulty_rules, Problem)),
    retract(faulty_rules:(affordTask(_, broken) :- _)),
    prepare_rules(faulty_rules, faulty),
    !.
test(misspelt_quantities_are_problems,
     true(sub_string(Problem, _, _, _, "a quantity that is not known: at_least(strech(_), 2)"))) :-
    assertz(faulty_rules:(affordTask(ID, broken) :- part(ID), at_least(strech(ID), 2))),
    prepare_rules(faulty_rules, faulty),
    once(rule_problem(faulty_rules, Problem)),
    retract(faulty_rules:(affordTask(_, broken) :- _)),
    prepare_rules(faulty_rules, faulty),
    !.
test(the_thesis_has_no_problems, fail) :-
    rule_problem(thesis_version1, _).
test(rules_know_where_they_are_written, true(Line > 0)) :-
    once(rule_about(thesis_version1, affordTask(_, pouring), Line)).
test(goals_are_shown_with_the_names_of_the_file, true(Text == "X > foo(Y, _)")) :-
    as_written(A > foo(B, _), ['X' = A, 'Y' = B], Text).

:- end_tests(reading).
