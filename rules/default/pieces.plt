:- use_module('../sketch').
:- use_module('../quantities').
:- use_module(pieces).
:- use_module(library(plunit)).

:- include('household.inc').

:- begin_tests(default_pieces, [cleanup(wipe)]).

test(no_part_of_a_household_object_continues_another,
     [forall(member(Thing, [pan, ladle, coffee_spoon, turner, hammer, bottle, knife, scissors,
                            screwdriver, mug])), fail]) :-
    on_table(Thing), continues(_, _).

test(in_line, Pairs == [0-1, 1-0]) :-
    sketch([ box([0, 0, 0], [0.12, 0.025, 0.02], []), box([0.11, 0, 0], [0.1, 0.022, 0.019], []) ]),
    findall(A-B, continues(A, B), All), sort(All, Pairs).
test(side_by_side, all(Pair == [0-1, 1-0])) :-
    sketch([ box([0, 0, 0], [0.1, 0.04, 0.004], []), box([0, 0.04, 0], [0.1, 0.04, 0.004], []) ]),
    continues(A, B), Pair = A-B.
test(at_an_angle, fail) :-
    sketch([ box([0, 0, 0], [0.12, 0.02, 0.02], []), box([0.05, 0.07, 0], [0.02, 0.12, 0.02], []) ]),
    continues(_, _).
test(a_bend_in_a_limb, all(Pair == [0-1, 1-0])) :-
    sketch([ box([0, 0, 0], [0.1, 0.02, 0.01], []), box([0.1, 0.012, 0.006], [0.1, 0.013, 0.009], []) ]),
    \+ at_least(likeness(0, 1), 0.66),
    continues(A, B), Pair = A-B.
test(apart, fail) :-
    sketch([ box([0, 0, 0], [0.1, 0.02, 0.02], []), box([0.15, 0, 0], [0.1, 0.02, 0.02], []) ]),
    continues(_, _).
test(narrower, fail) :-
    sketch([ box([0, 0, 0], [0.1, 0.06, 0.02], []), box([0.1, 0, 0], [0.1, 0.02, 0.02], []) ]),
    continues(_, _).
test(one_with_openings, fail) :-
    sketch([ box([0, 0, 0], [0.1, 0.06, 0.01], [holes(2)]), box([0.1, 0, 0], [0.1, 0.06, 0.01], []) ]),
    continues(_, _).

:- end_tests(default_pieces).
