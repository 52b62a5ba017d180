/*  Rule set `default`, reasoning Version 1: one rule per task.

    As in the thesis, each rule looks for the part to hold (ID) and the part that
    acts (ID_tool), and says what both are like for this task. How a handle is
    known is in handles.pl, for it is the same whatever the handle is used for.
*/

:- module(default_version1, [affordTask/2, goes_with/2, one_with/2, held_together/1]).
:- use_module('../predicates').
:- use_module('../quantities').
:- use_module(handles).
:- use_module(pieces).

%!  one_with(?ID, ?Other) is nondet.
%
%   The two are pieces of one part, for all rules.

one_with(ID, Other) :-
    continues(ID, Other).

%!  goes_with(?ID, ?Other) is nondet.
%
%   Whoever may hold Other may hold part ID: a piece of the same handle or body.

goes_with(ID, Other) :-
    belongs_to(ID, Other).

%!  held_together(?Task) is nondet.
%
%   A handle that was recovered in two pieces is one region.

held_together(_).

%!  affordTask(?ID, ?Task) is nondet.
%
%   Part ID is one to hold for Task.

%   A wide pot or pan at the end of a handle.

affordTask(ID, cooking) :-
    stem(ID, ID_tool),
    at_least(width(ID_tool), 0.1),
    at_least(thickness(ID_tool), 0.025),
    at_most(length(ID_tool) / width(ID_tool), 1.5),
    at_least(along(ID_tool) / object_length, 0.35).

%   A solid head that lies across the handle.

affordTask(ID, hammering) :-
    stem(ID, ID_tool),
    at_least(thickness(ID_tool), 0.012),
    at_least(thickness(ID_tool) / thickness(ID), 0.4),
    at_most(width(ID_tool) / thickness(ID), 4),
    at_most(length(ID_tool), 0.2),
    at_least(length(ID_tool) / width(ID_tool), 1.4),
    at_least(slant(ID_tool), 45).

%   A mug is poured by its ear, a bottle by its body.

affordTask(ID, pouring) :-
    ear(ID, ID_tool),
    at_least(thickness(ID_tool), 0.04).
affordTask(ID, pouring) :-
    body(ID),
    at_least(thickness(ID), 0.03),
    at_least(width(ID), 0.045),
    at_most(length(ID) / thickness(ID), 5.5).

%   A bowl, small beside its handle, that is no hammer's head.

affordTask(ID, scooping) :-
    stem(ID, ID_tool),
    at_least(thickness(ID_tool), 0.006),
    at_most(length(ID_tool) / width(ID_tool), 2.2),
    at_most(length(ID_tool), 0.15),
    at_most(length(ID_tool) / length(ID), 0.8),
    \+ affordTask(ID, hammering).

%   A flat blade, wide for its handle.

affordTask(ID, turning) :-
    stem(ID, ID_tool),
    at_least(width(ID_tool), 0.035),
    at_most(thickness(ID_tool), 0.03),
    at_most(thickness(ID_tool) / thickness(ID), 1.7),
    at_most(thickness(ID_tool) / width(ID_tool), 0.25),
    \+ affordTask(ID, hammering).

%   The haft of a thin flat blade, or the rings of scissors.

affordTask(ID, cutting) :-
    haft(ID, ID_tool),
    at_least(width(ID_tool) / width(ID), 0.65),
    at_most(thickness(ID_tool) / width(ID_tool), 0.55),
    at_least(length(ID_tool) / width(ID_tool), 1.8).
affordTask(ID, cutting) :-
    rings(ID, ID_tool),
    at_most(thickness(ID_tool), 0.025).

%   What the other person does not take, if there is anything else to hold.

affordTask(ID, handover) :-
    part(ID),
    \+ taken_in_use(ID).
affordTask(ID, handover) :-
    part(ID),
    \+ left_over(_).

left_over(ID) :-
    part(ID),
    \+ taken_in_use(ID).
