/*  Rule set `default`, reasoning Version 2: what a part can serve as.

    The affordances are those of the ontology (Table 6.1 of the thesis), the
    relations between tasks and affordances stay there. How a part is known is
    ours: by how it lies in the object and what it is joined to (quantities.pl,
    handles.pl) instead of by its own dimensions alone.

    - grasp is a handle to work with, hence not the ear of a mug. wrap_grasp is what
      a person's hand goes around in use: any handle, or the body of an object
      without one. Handing over leaves it free.
    - The functional parts (pound, scoop, support, cut) are known by the handle
      that carries them: the same block is no hammer without one.
*/

:- module(default_version2, [partAffordance/2, goes_with/2, one_with/2, held_together/1, held_if_alone/1]).
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

%!  held_if_alone(?Task) is nondet.
%
%   A can is handed over although it is all body.

held_if_alone(handover).

%!  partAffordance(?ID, ?Affordance) is nondet.
%
%   Part ID can serve as Affordance.

partAffordance(ID, grasp) :-
    lever(ID, _).

partAffordance(ID, wrap_grasp) :-
    taken_in_use(ID).

%   Thick enough to be hollow, not drawn out, and a good share of the object: the
%   bowl of a ladle is small beside its handle, the pot of a pan is not.

partAffordance(ID, contain) :-
    part(ID),
    at_least(thickness(ID), 0.03),
    at_least(width(ID), 0.045),
    at_most(length(ID) / thickness(ID), 8),
    at_most(stretch(ID), 4.5),
    at_least(along(ID) / object_length, 0.4),
    \+ handle(ID, _).

%   A solid head that lies across its handle.

partAffordance(ID, pound) :-
    stem(ID_handle, ID),
    at_least(thickness(ID), 0.012),
    at_least(thickness(ID) / thickness(ID_handle), 0.4),
    at_most(width(ID) / thickness(ID_handle), 4),
    at_most(length(ID), 0.2),
    at_least(length(ID) / width(ID), 1.4),
    at_least(slant(ID), 45).

%   Flat, and wide for the handle that carries it.

partAffordance(ID, support) :-
    stem(ID_handle, ID),
    at_least(width(ID), 0.035),
    at_most(thickness(ID) / width(ID), 0.25),
    at_most(thickness(ID), 0.03),
    at_most(thickness(ID) / thickness(ID_handle), 1.7),
    \+ partAffordance(ID, pound).

%   Deep enough to hold something, round or oval, and not as large as a pot.

partAffordance(ID, scoop) :-
    stem(ID_handle, ID),
    at_least(thickness(ID), 0.006),
    at_most(length(ID) / width(ID), 2.2),
    at_most(length(ID), 0.15),
    at_most(length(ID) / length(ID_handle), 0.8),
    \+ partAffordance(ID, pound).

%   A thin flat blade in line with its haft, or the blades of scissors.

partAffordance(ID, cut) :-
    haft(ID_handle, ID),
    at_least(width(ID) / width(ID_handle), 0.65),
    at_most(thickness(ID) / width(ID), 0.55),
    at_least(length(ID) / width(ID), 1.8).
partAffordance(ID, cut) :-
    rings(_, ID),
    at_most(thickness(ID), 0.025).
