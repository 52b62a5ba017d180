/*  Rule set `default`: what makes a part the one that a hand takes.

    Shared by both versions. Sizes in metres are those of a hand, or of its tool;
    everything else is relative, so that a coffee spoon and a soup ladle, or a
    skillet and a stockpot, are judged alike.

    Four kinds of handle, each known by what it carries:

        stem    long and narrow along the object, with something stubbier and
                wider at its end: pan, ladle, spoon, turner, hammer
        haft    in line with something long and much thinner: knife, screwdriver
        rings   with an opening for the fingers, in line with something long that
                has none: scissors
        ear     small, at the side of a vessel, close to it: mug

    And, where nothing is a handle:

        body    what a hand closes around because there is no handle: bottle, can
*/

:- module(default_handles,
          [ handle/2,                   % ?ID, ?Tool
            lever/2,                    % ?ID, ?Tool
            stem/2,                     % ?ID, ?Tool
            haft/2,                     % ?ID, ?Tool
            rings/2,                    % ?ID, ?Tool
            ear/2,                      % ?ID, ?Tool
            body/1,                     % ?ID
            taken_in_use/1,             % ?ID
            belongs_to/2                % ?ID, ?Other
          ]).
:- use_module('../predicates').
:- use_module('../quantities').

%!  handle(?ID, ?Tool) is nondet.
%
%   Part ID is a handle, of any kind, and carries part Tool.

handle(ID, Tool) :- lever(ID, Tool).
handle(ID, Tool) :- ear(ID, Tool).

%!  lever(?ID, ?Tool) is nondet.
%
%   A handle that keeps the hand away from what it carries, so that one can work
%   with that: any kind but an ear.

lever(ID, Tool) :- stem(ID, Tool).
lever(ID, Tool) :- haft(ID, Tool).
lever(ID, Tool) :- rings(ID, Tool).

%!  stem(?ID, ?Tool) is nondet.
%
%   Elongation is measured along the object's main axis: a hammer's head is long
%   too, but across it. Neither the neck of a bottle (its body is as elongated) nor
%   the blades of scissors (what is wider there are rings) are stems, nor is the shaft
%   of a screwdriver (what is wider there is a haft, long itself).

stem(ID, Tool) :-
    part(ID),
    at_least(seen(ID), 0.01),
    at_most(thickness(ID), 0.06),
    at_most(width(ID), 0.13),
    at_least(length(ID), 0.04),
    at_least(stretch(ID), 1.5),
    part(Tool),
    ID \= Tool,
    at_least(stretch(ID) / stretch(Tool), 1.6),
    at_least(seen(Tool), 0.01),
    at_most(width(ID) / across(Tool), 1.1),
    \+ outweighed(Tool, ID),
    stubby(Tool),
    \+ rings(Tool, ID).

%   Hardly longer than wide along the object; a flat blade or bowl may be longer.

stubby(Tool) :-
    at_most(stretch(Tool), 1.5).
stubby(Tool) :-
    at_most(stretch(Tool), 2.3),
    at_most(thickness(Tool) / width(Tool), 0.55).

%   Another part, no handle either, is a good deal larger: then that is the tool, and
%   this is a hook, or a piece of it.

outweighed(Tool, ID) :-
    part(Other),
    Other \= Tool,
    Other \= ID,
    at_most(stretch(Other), 2),
    at_least(volume(Other) / volume(Tool), 1.5).

%!  haft(?ID, ?Tool) is nondet.
%
%   Both lie at an end of the object.

haft(ID, Tool) :-
    part(ID),
    at_least(seen(ID), 0.01),
    at_least(thickness(ID), 0.008),
    at_most(thickness(ID), 0.05),
    at_most(width(ID), 0.065),
    at_least(stretch(ID), 2),
    at_most(end_gap(ID), 0.1),
    part(Tool),
    ID \= Tool,
    at_least(seen(Tool), 0.01),
    at_least(stretch(Tool), 2),
    at_most(thickness(Tool), 0.015),
    at_most(thickness(Tool) / thickness(ID), 0.8),
    at_most(end_gap(Tool), 0.1).

%!  rings(?ID, ?Tool) is nondet.
%
%   A slotted turner has openings too, but those of its blade, which is thinner than
%   its handle. A gap that the sensor left in the bowl of a spoon looks like an
%   opening, but what it would carry is far longer.

rings(ID, Tool) :-
    part(ID),
    at_least(holes(ID), 1),
    at_most(thickness(ID), 0.03),
    part(Tool),
    ID \= Tool,
    at_most(holes(Tool), 0),
    at_least(stretch(Tool) / stretch(ID), 0.9),
    at_most(thickness(Tool) / thickness(ID), 1.8),
    at_most(length(Tool) / length(ID), 1.8).

%!  ear(?ID, ?Tool) is nondet.
%
%   It sticks out of the vessel by less than it is long, as a neck or a cap does not,
%   and lies at its side.

ear(ID, Tool) :-
    part(Tool),
    at_least(thickness(Tool), 0.04),
    at_most(length(Tool) / thickness(Tool), 2.5),
    part(ID),
    ID \= Tool,
    at_least(seen(ID), 0.01),
    at_most(thickness(ID), 0.04),
    at_most(thickness(ID) / length(ID), 0.5),
    at_most(length(ID) / length(Tool), 1.1),
    at_most(volume(ID) / volume(Tool), 0.35),
    at_most(reach(ID, Tool) / length(ID), 0.9),
    at_side(ID, Tool).

%   Not past the end of a vessel that is longer than wide.

at_side(ID, Tool) :-
    at_most(offset(ID, Tool), 0.8).
at_side(_, Tool) :-
    at_most(length(Tool) / width(Tool), 1.35).

%!  body(?ID) is nondet.
%
%   The largest part, or one as wide, if a hand or gripper can close around it.

body(ID) :-
    part(ID),
    at_least(thickness(ID), 0.025),
    at_most(thickness(ID), 0.1),
    at_most(width(ID), 0.12),
    at_least(along(ID) / object_length, 0.35),
    at_least(across(ID) / object_width, 0.82),
    \+ handle(_, _).

%!  taken_in_use(?ID) is nondet.
%
%   The part that a person takes to use the object.

taken_in_use(ID) :- handle_or_body(ID).
taken_in_use(ID) :-
    belongs_to(ID, Other),
    handle_or_body(Other).

handle_or_body(ID) :- handle(ID, _).
handle_or_body(ID) :- body(ID).

%!  belongs_to(?ID, ?Other) is nondet.
%
%   Part ID touches part Other and is a piece of the same: as wide and as thick, or
%   hardly seen.

belongs_to(ID, Other) :-
    part(ID),
    part(Other),
    ID \= Other,
    meets(ID, Other),
    at_least(across(ID) / across(Other), 0.85),
    at_most(across(ID) / across(Other), 1.18),
    at_least(thickness(ID) / thickness(Other), 0.75),
    at_most(thickness(ID) / thickness(Other), 1.33).
belongs_to(ID, Other) :-
    part(ID),
    at_most(seen(ID), 0.006),
    part(Other),
    ID \= Other,
    meets(ID, Other).
