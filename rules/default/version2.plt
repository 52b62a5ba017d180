:- use_module('../sketch').
:- use_module(version2).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).

:- include('household.inc').

:- begin_tests(default_version2, [cleanup(wipe)]).

%   The affordances of each part.

afforded(pan, 0, [contain]).
afforded(pan, 1, [grasp, wrap_grasp]).
afforded(ladle, 0, [scoop]).
afforded(coffee_spoon, 0, [scoop]).
afforded(turner, 0, [support]).
afforded(slotted_turner, 0, [support]).
afforded(hammer, 0, [pound]).
afforded(mallet, 0, [pound]).
afforded(bottle, 0, [contain, wrap_grasp]).
afforded(bottle, 1, []).
afforded(knife, 0, [cut]).
afforded(knife, 1, [grasp, wrap_grasp]).
afforded(scissors, 0, [cut]).
afforded(scissors, 1, [grasp, wrap_grasp]).
afforded(screwdriver, 0, []).
afforded(screwdriver, 1, [grasp, wrap_grasp]).
afforded(mug, 0, [contain]).
afforded(mug, 1, [wrap_grasp]).
afforded(can, 0, [contain, wrap_grasp]).

test(afforded, [forall(afforded(Thing, ID, Expected)), true(Thing-ID-Found == Thing-ID-Expected)]) :-
    on_table(Thing),
    findall(A, partAffordance(ID, A), All),
    sort(All, Found).

%   The same block is no hammer without a handle.

test(a_head_alone_does_not_pound, fail) :-
    sketch([box([0, 0, 0.02], [0.03, 0.11, 0.03], [shape(cuboid)])]),
    partAffordance(_, pound).
test(a_head_along_the_handle_does_not_pound, fail) :-
    sketch([ box([0, 0, 0.02], [0.11, 0.06, 0.03], []), box([0.185, 0, 0.02], [0.26, 0.035, 0.025], []) ]),
    partAffordance(_, pound).

test(affordances, all(A == [contain, cut, grasp, pound, scoop, support, wrap_grasp])) :-
    setof(Affordance, ID^B^clause(default_version2:partAffordance(ID, Affordance), B), As),
    member(A, As).
test(a_can_is_handed_over) :- held_if_alone(handover).
test(a_can_is_not_poured_if_it_were_to_be_avoided, fail) :- held_if_alone(pouring).
test(pieces_are_held_together) :- held_together(cooking).

:- end_tests(default_version2).
