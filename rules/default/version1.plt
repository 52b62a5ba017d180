:- use_module('../sketch').
:- use_module(version1).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).

:- include('household.inc').

:- begin_tests(default_version1, [cleanup(wipe)]).

%   What each thing is for, and the part to hold then.

held(pan, cooking, [1]).
held(pan, handover, [0]).
held(ladle, scooping, [1]).
held(ladle, handover, [0]).
held(coffee_spoon, scooping, [1]).
held(coffee_spoon, handover, [0]).
held(turner, turning, [1]).
held(slotted_turner, turning, [1]).
held(turner, handover, [0]).
held(hammer, hammering, [1]).
held(hammer, handover, [0]).
held(mallet, hammering, [1]).
held(bottle, pouring, [0]).
held(bottle, handover, [1]).
held(knife, cutting, [1]).
held(knife, handover, [0]).
held(scissors, cutting, [1]).
held(scissors, handover, [0]).
held(screwdriver, handover, [0]).
held(mug, pouring, [1]).
held(mug, handover, [0]).
held(can, pouring, [0]).
held(can, handover, [0]).
held(carton, handover, [0]).

%   What it clearly cannot do.

refused(pan, [cutting, hammering, scooping]).
refused(ladle, [cutting, hammering, cooking, pouring]).
refused(coffee_spoon, [cutting, hammering, cooking, pouring]).
refused(turner, [hammering, pouring, cooking, cutting]).
refused(hammer, [cooking, cutting, pouring, scooping, turning]).
refused(mallet, [cooking, cutting, pouring, scooping, turning]).
refused(bottle, [cooking, cutting, hammering, scooping, turning]).
refused(knife, [cooking, hammering, pouring, scooping]).
refused(scissors, [cooking, hammering, pouring, scooping, turning]).
refused(screwdriver, [cooking, cutting, pouring, scooping]).
refused(mug, [cooking, cutting, hammering, scooping, turning]).
refused(can, [cooking, cutting, hammering, scooping, turning]).
refused(carton, [cooking, cutting, hammering, scooping, turning]).

test(held, [forall(held(Thing, Task, Expected)), true(Thing-Task-Found == Thing-Task-Expected)]) :-
    on_table(Thing),
    findall(ID, affordTask(ID, Task), All),
    sort(All, Found).
test(refused, [forall(( refused(Thing, Tasks), member(Task, Tasks) )),
               true(Thing-Task-Found == Thing-Task-[])]) :-
    on_table(Thing),
    findall(ID, affordTask(ID, Task), Found).

test(tasks, all(Task == [cooking, cutting, hammering, handover, pouring, scooping, turning])) :-
    setof(T, ID^B^clause(default_version1:affordTask(ID, T), B), Tasks),
    member(Task, Tasks).
test(pieces_are_held_together) :- held_together(cooking).

:- end_tests(default_version1).
