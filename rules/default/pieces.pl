/*  Rule set `default`: which recovered parts are pieces of one.

    A part may be recovered in several pieces: a long handle with a bend, a bottle
    behind which something stands, a blade with a hole. What the pieces of one have in
    common is that one goes on as the other ends. Before anything else is asked such
    pieces are made one part, so that no rule needs to know of them.
*/

:- module(default_pieces, [continues/2]).       % ?ID, ?Other
:- use_module('../predicates').
:- use_module('../quantities').

%!  continues(?ID, ?Other) is nondet.
%
%   The two meet, either both have openings or none, and one of these:
%
%   Flush: cross-sections are alike where they meet, and they lie in line or side by
%   side, or else their common box would be half empty.

continues(ID, Other) :-
    two_that_meet(ID, Other),
    at_least(likeness(ID, Other), 0.65),
    at_least(filling(ID, Other), 0.65),
    as_thick(ID, Other),
    alike_in_openings(ID, Other).

%   End to end, at a slight angle: the handle of a spoon.

continues(ID, Other) :-
    two_that_meet(ID, Other),
    at_least(length(ID) / width(ID), 2.5),
    at_least(length(Other) / width(Other), 2.5),
    at_most(bend(ID, Other), 35),
    at_least(offset(ID, Other), 0.9),
    at_least(offset(Other, ID), 0.9),
    at_least(width(ID) / width(Other), 0.55),
    at_most(width(ID) / width(Other), 1.82),
    as_thick(ID, Other),
    alike_in_openings(ID, Other).

two_that_meet(ID, Other) :-
    part(ID),
    part(Other),
    ID \= Other,
    meets(ID, Other).

as_thick(ID, Other) :-
    at_least(thickness(ID) / thickness(Other), 0.7),
    at_most(thickness(ID) / thickness(Other), 1.43).

alike_in_openings(ID, Other) :-
    at_most(holes(ID), 0),
    at_most(holes(Other), 0).
alike_in_openings(ID, Other) :-
    at_least(holes(ID), 1),
    at_least(holes(Other), 1).
