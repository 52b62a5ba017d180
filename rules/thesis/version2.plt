:- use_module('../predicates').
:- use_module(version2).
:- use_module(library(plunit)).

:- begin_tests(thesis_version2, [cleanup(withdraw_parts)]).

part(Dimensions, Shape) :-
    withdraw_parts,
    state_part(0, [0, 0, 0.7], Dimensions, [0.5, 0.5], Shape, 1.0).

test(handle, [setup(part([0.02, 0.03, 0.2], cylinder)), all(A == [grasp, pound])]) :-
    partAffordance(0, A).
test(bottle, [setup(part([0.07, 0.07, 0.2], cylinder)), all(A == [wrap_grasp, contain, pound])]) :-
    partAffordance(0, A).
test(bowl, [setup(part([0.08, 0.08, 0.05], sphere)), all(A == [scoop])]) :-
    partAffordance(0, A).
test(sheet, [setup(part([0.01, 0.09, 0.1], cuboid)), all(A == [support])]) :-
    partAffordance(0, A).
test(blade, [setup(part([0.005, 0.03, 0.18], cuboid)), all(A == [grasp, cut])]) :-
    partAffordance(0, A).
test(speck, [setup(part([0.002, 0.002, 0.002], sphere)), fail]) :-
    partAffordance(0, _).

test(only_the_largest_part_contains, [setup(two_cylinders), all(ID == [1])]) :-
    partAffordance(ID, contain).

two_cylinders :-
    part([0.05, 0.05, 0.05], cylinder),
    state_part(1, [0, 0, 0.7], [0.06, 0.06, 0.06], [0.5, 0.5], cylinder, 1.0).

test(affordances, all(A == [grasp, wrap_grasp, contain, pound, support, scoop, cut])) :-
    clause(thesis_version2:partAffordance(_, A), _).

:- end_tests(thesis_version2).
