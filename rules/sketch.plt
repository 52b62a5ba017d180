:- use_module(sketch).
:- use_module(predicates).
:- use_module(quantities).
:- use_module(library(lists)).
:- use_module(library(plunit)).

:- begin_tests(sketch, [setup(pan), cleanup(wipe)]).

pan :-
    sketch([ box([0, 0, 0.03], [0.2, 0.2, 0.06], [seen(3)]),
             box([0.2, 0, 0.03], [0.2, 0.03, 0.02], [shape(cuboid), holes(1)]) ]).

near(A, B) :- abs(A - B) < 1.0e-9.

test(parts, all(P == [0-cylinder, 1-cuboid])) :-
    primitive_values(ID, _, Shape), P = ID-Shape.
test(length, true(near(L, 0.4))) :- quantity(object_length, L, m).
test(end, true(near(G, 0))) :- quantity(end_gap(1), G, ratio).
test(inner_part, true(near(G, 0.25))) :-
    sketch([ box([0, 0, 0], [0.1, 0.1, 0.1], []), box([0.1, 0, 0], [0.1, 0.1, 0.1], []),
             box([0.25, 0, 0], [0.2, 0.1, 0.1], []) ]),
    quantity(end_gap(1), G, ratio).
test(seen, true(near(S, 0.75))) :- pan, quantity(seen(0), S, ratio).
test(reach, true(near(R, 0.2))) :- pan, quantity(reach(1, 0), R, m).
test(offset, true(near(O, 2))) :- pan, quantity(offset(1, 0), O, ratio).
test(they_meet, all(P == [1-0, 0-1])) :- pan, member(P, [1-0, 0-1]), P = A-B, once(meets(A, B)).
test(apart, fail) :-
    sketch([ box([0, 0, 0], [0.1, 0.1, 0.1], []), box([0.2, 0, 0], [0.08, 0.1, 0.1], []) ]),
    meets(0, 1).
test(wiped, fail) :- wipe, part(_).

:- end_tests(sketch).
