:- use_module('../predicates').
:- use_module(version1).
:- use_module(library(plunit)).

:- begin_tests(thesis_version1, [cleanup(withdraw_parts)]).

object(Parts) :-
    withdraw_parts,
    forall(nth0(ID, Parts, Dimensions-Shape),
           state_part(ID, [0, 0, 0.7], Dimensions, [0.5, 0.5], Shape, 1.0)).

pan :- object([[0.18, 0.18, 0.06]-cylinder, [0.02, 0.03, 0.2]-cylinder]).
hammer :- object([[0.035, 0.025, 0.3]-cuboid, [0.03, 0.03, 0.1]-cuboid]).
bottle :- object([[0.07, 0.07, 0.2]-cylinder, [0.03, 0.03, 0.03]-cylinder]).
ladle :- object([[0.08, 0.08, 0.05]-sphere, [0.004, 0.02, 0.25]-cuboid]).
turner :- object([[0.02, 0.09, 0.1]-cuboid, [0.02, 0.02, 0.25]-cylinder]).
knife :- object([[0.002, 0.03, 0.18]-cuboid, [0.015, 0.025, 0.11]-cuboid]).

test(pan_is_held_by_the_handle, [setup(pan), all(ID == [1])]) :- affordTask(ID, cooking).
test(hammer_is_held_by_the_handle, [setup(hammer), all(ID == [0])]) :- affordTask(ID, hammering).
test(bottle_is_held_by_the_body, [setup(bottle), all(ID == [0])]) :- affordTask(ID, pouring).
test(ladle_is_held_by_the_handle, [setup(ladle), all(ID == [1])]) :- affordTask(ID, scooping).
test(turner_is_held_by_the_handle, [setup(turner), all(ID == [1])]) :- affordTask(ID, turning).
test(knife_is_held_by_the_handle, [setup(knife), all(ID == [1])]) :- affordTask(ID, cutting).
test(smallest_part_is_handed_over, [setup(pan), all(ID == [1])]) :- affordTask(ID, handover).

test(one_part_cannot_be_tool_and_handle, [setup(object([[0.02, 0.03, 0.2]-cylinder])), fail]) :-
    affordTask(_, hammering).
test(bottle_does_not_cut, [setup(bottle), fail]) :- affordTask(_, cutting).
test(pan_does_not_pour, [setup(pan), fail]) :- affordTask(_, pouring).
test(dimensions_are_full_extents, [setup(object([[0.081, 0.081, 0.2]-cylinder])), fail]) :-
    affordTask(_, pouring).

test(tasks, all(Task == [cooking, hammering, pouring, scooping, turning, handover, cutting])) :-
    clause(thesis_version1:affordTask(_, Task), _).

:- end_tests(thesis_version1).
