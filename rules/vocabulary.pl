/*  The words of rules that are written as data.

    An expert can teach a rule without writing Prolog: as a list of conditions,
    each one of the words below (docs/decisions/0017-growing-knowledge.md). These
    tables are the only way from such a word to a goal. A goal is built here, from
    a pattern; no text and no name that comes from outside is ever called.

    A new predicate is one row of fixed/6. A new quantity of quantities.pl is one
    row of measured/6 or compared/6, which makes the words min_<name> and
    max_<name>. The service asks for the words and checks what it is given
    against them.

    What a word takes:

        nothing
        number(Quantity, Direction, Low, High)
                        one number from Low to High; Direction (min or max) says
                        whether it bounds Quantity from below or from above
        lengths(Direction)
                        three bounds in metres on thickness, width and length
        shapes          one or more shape classes
        affordance      the name of a part affordance
*/

:- module(vocabulary,
          [ word/6,                     % ?Name, ?Parts, ?Takes, ?Value, -Goal, ?Says
            words/1                     % -Words
          ]).
:- use_module(predicates).
:- use_module(quantities).
:- use_module(library(lists)).

%!  word(?Name, ?Parts, ?Takes, ?Value, -Goal, ?Says) is nondet.
%
%   Parts is a list of part(ID, Dimensions, Shape), as primitive_values finds
%   them.

word(Name, Parts, Takes, Value, Goal, Says) :-
    fixed(Name, Parts, Takes, Value, Goal, Says).
word(Name, Parts, number(Quantity, Direction, Low, High), Bound, Goal, Says) :-
    (   Parts = [part(ID, _, _)],
        measured(Quantity, ID, Term, Low, High, What)
    ;   Parts = [part(A, _, _), part(B, _, _)],
        compared(Quantity, A, B, Term, [Low, High], What)
    ),
    bounded(Direction, Term, Bound, Goal, Prefix, Start),
    atom_concat(Prefix, Quantity, Name),
    string_concat(Start, What, Says).

bounded(min, Term, Bound, at_least(Term, Bound), min_, "at least: ").
bounded(max, Term, Bound, at_most(Term, Bound), max_, "at most: ").

                /*******************************
                *          THE WORDS           *
                *******************************/

%   fixed(Name, Parts, Takes, Value, Goal, Says)

fixed(min_dimension, [part(_, Dim, _)], lengths(min), Bound, min_dimension(Dim, Bound),
      "sorted extents of at least [thickness, width, length]").
fixed(max_dimension, [part(_, Dim, _)], lengths(max), Bound, max_dimension(Dim, Bound),
      "sorted extents of at most [thickness, width, length]").
fixed(min_ratio, [part(_, Dim, _)], number(ratio, min, 1, 1000), Bound, min_ratio(Dim, Bound),
      "at least so many times as long as thick").
fixed(max_ratio, [part(_, Dim, _)], number(ratio, max, 1, 1000), Bound, max_ratio(Dim, Bound),
      "at most so many times as long as thick").
fixed(shape, [part(_, _, Shape)], shapes, Classes, Goal,
      "of one of these classes: cuboid, cylinder, sphere") :-
    one_of(Classes, Shape, Goal).
fixed(largest, [part(ID, _, _)], nothing, _, max_shape(ID),
      "no other part encloses more").
fixed(smallest, [part(ID, _, _)], nothing, _, min_shape(ID),
      "no other part encloses less").
fixed(fits_gripper, [part(ID, _, _)], nothing, _, fits_gripper(ID),
      "goes between the fingers of the gripper asked for, if its opening is known").
fixed(affords, [part(ID, _, _)], affordance, Affordance, partAffordance(ID, Affordance),
      "counts as this affordance, by any rule for it").
fixed(affords_not, [part(ID, _, _)], affordance, Affordance, \+ partAffordance(ID, Affordance),
      "does not count as this affordance, by any rule for it").
fixed(different, [part(A, _, _), part(B, _, _)], nothing, _, A \= B,
      "two different parts").
fixed(touching, [part(A, _, _), part(B, _, _)], nothing, _, meets(A, B),
      "the two parts meet").

%   measured(Name, ID, Term, Low, High, Says): a quantity of one part; Low and High are
%   the values that make sense.

measured(thickness, ID, thickness(ID), 0, 10, "smallest extent in metres").
measured(width, ID, width(ID), 0, 10, "middle extent in metres").
measured(length, ID, length(ID), 0, 10, "largest extent in metres").
measured(flatness, ID, thickness(ID) / width(ID), 0, 1, "thickness over width").
measured(volume, ID, volume(ID), 0, 1000, "what it encloses, in cubic metres").
measured(along, ID, along(ID), 0, 10, "extent along the object's main axis, in metres").
measured(across, ID, across(ID), 0, 10, "larger extent across the main axis, in metres").
measured(share_along, ID, along(ID) / object_length, 0, 1, "share of the object's length").
measured(share_across, ID, across(ID) / object_width, 0, 1, "share of the object's width").
measured(stretch, ID, stretch(ID), 0, 1000, "extent along the main axis over that across it").
measured(slant, ID, slant(ID), 0, 90, "angle to the main axis, in degrees").
measured(end_gap, ID, end_gap(ID), 0, 1, "distance from the nearer end, as a share of the length").
measured(seen, ID, seen(ID), 0, 1, "share of the points of the object that belong to it").
measured(bottom, ID, bottom(ID), -10, 10, "lowest point above the support, in metres").
measured(top, ID, top(ID), -10, 10, "highest point above the support, in metres").
measured(gripper_share, ID, thickness(ID) / gripper_opening, 0, 1000,
         "thickness over the gripper's widest opening; fails if that is not known").
measured(holes, ID, holes(ID), 0, 100, "openings through the part").

%   compared(Name, A, B, Term, [Low, High], Says): a quantity of two parts.

compared(relative_thickness, A, B, thickness(A) / thickness(B), [0, 1000],
         "thickness of the first over that of the second").
compared(relative_width, A, B, width(A) / width(B), [0, 1000],
         "width of the first over that of the second").
compared(relative_length, A, B, length(A) / length(B), [0, 1000],
         "length of the first over that of the second").
compared(relative_volume, A, B, volume(A) / volume(B), [0, 1000000],
         "volume of the first over that of the second").
compared(relative_stretch, A, B, stretch(A) / stretch(B), [0, 1000],
         "stretch of the first over that of the second").
compared(likeness, A, B, likeness(A, B), [0, 1],
         "of two that meet: smaller cross-section over the larger, across the line between them").
compared(filling, A, B, filling(A, B), [0, 10],
         "of two that meet: share of the box around both that their boxes fill").
compared(bend, A, B, bend(A, B), [0, 90],
         "of two that meet: angle between their longest axes, in degrees").
compared(reach, A, B, reach(A, B), [-10, 10],
         "how far the first sticks out of the second, in metres").
compared(offset, A, B, offset(A, B), [0, 1000],
         "distance of the first along the longest axis of the second, in halves of its length").

one_of(Classes, Shape, Goal) :-
    is_list(Classes),
    !,
    disjunction(Classes, Shape, Goal).
one_of(_, _, fail).                     % only listed, not used

disjunction([Class], Shape, Shape == Class) :- !.
disjunction([Class|Classes], Shape, (Shape == Class ; Goal)) :-
    disjunction(Classes, Shape, Goal).

%!  words(-Words) is det.
%
%   The words as dicts, for the service.

words(Words) :-
    findall(Word, described(Word), Words).

described(word{name: Name, parts: Number, takes: Kind, says: Says, quantity: Quantity,
               direction: Direction, low: Low, high: High}) :-
    word(Name, Parts, Takes, _, _, Says),
    length(Parts, Number),
    taken(Takes, Kind, Quantity, Direction, Low, High).

taken(nothing, nothing, null, null, null, null).
taken(number(Quantity, Direction, Low, High), number, Quantity, Direction, Low, High).
taken(lengths(Direction), lengths, dimension, Direction, 0, 10).
taken(shapes, shapes, null, null, null, null).
taken(affordance, affordance, null, null, null, null).
