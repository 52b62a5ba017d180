:- use_module('../sketch').
:- use_module(handles).
:- use_module(library(apply)).
:- use_module(library(plunit)).
:- use_module(library(solution_sequences)).

:- include('household.inc').

:- begin_tests(default_handles, [cleanup(wipe)]).

kind(ID, Tool, stem) :- stem(ID, Tool).
kind(ID, Tool, haft) :- haft(ID, Tool).
kind(ID, Tool, rings) :- rings(ID, Tool).
kind(ID, Tool, ear) :- ear(ID, Tool).

kinds(Thing, Kinds) :-
    on_table(Thing),
    findall(K-ID-Tool, kind(ID, Tool, K), All),
    sort(All, Kinds).

test(stems, [forall(member(Thing, [pan, ladle, coffee_spoon, turner, slotted_turner, hammer, mallet])),
             true(Kinds == [stem-1-0])]) :-
    kinds(Thing, Kinds).
test(hafts, [forall(member(Thing, [knife, screwdriver])), true(Kinds == [haft-1-0])]) :-
    kinds(Thing, Kinds).
test(rings, true(Kinds == [rings-1-0])) :- kinds(scissors, Kinds).
test(ear, true(Kinds == [ear-1-0])) :- kinds(mug, Kinds).
test(no_handle, [forall(member(Thing, [bottle, can, carton])), true(Kinds == [])]) :-
    kinds(Thing, Kinds).

test(body, [forall(member(Thing, [bottle, can])), all(ID == [0])]) :-
    on_table(Thing), body(ID).
test(a_handle_leaves_no_body, [forall(member(Thing, [mug, ladle, pan])), fail]) :-
    on_table(Thing), body(_).
test(a_carton_is_too_wide_for_a_hand, fail) :- on_table(carton), body(_).

%   Judged by proportion: no size between a coffee spoon's and a ladle's matters.

test(any_size, [forall(member(Scale, [1, 1.5, 2, 3])), true(Tools == [0])]) :-
    on_table(coffee_spoon, Scale),
    findall(Tool, stem(1, Tool), All),
    sort(All, Tools).

test(as_thick_as_a_leg, fail) :-
    sketch([ box([0, 0, 0], [0.3, 0.3, 0.1], []), box([0.3, 0, 0], [0.3, 0.08, 0.08], []) ]),
    handle(_, _).

%   A handle in two pieces is a handle twice.

test(two_pieces, all(ID == [1, 2])) :-
    sketch([ box([0, 0, 0.03], [0.09, 0.09, 0.05], []), box([0.105, 0, 0.03], [0.12, 0.022, 0.012], []),
             box([0.225, 0, 0.03], [0.12, 0.022, 0.012], []) ]),
    distinct(ID, stem(ID, 0)).

%   The neck of a wine bottle is long, but so is the bottle.

test(neck_of_a_wine_bottle, fail) :-
    sketch([ box([0, 0, 0], [0.21, 0.075, 0.075], []), box([0.15, 0, 0], [0.09, 0.028, 0.028], []) ]),
    handle(_, _).

%   The knob on the end of a hammer's handle is no tool beside its head.

test(knob, all(Tool == [0])) :-
    thing(hammer, Boxes),
    append(Boxes, [box([0.285, 0, 0.02], [0.02, 0.045, 0.03], [])], WithKnob),
    sketch(WithKnob),
    stem(1, Tool).

test(hardly_seen, fail) :-
    sketch([ box([0, 0, 0.03], [0.24, 0.24, 0.06], [seen(1000)]),
             box([0.2, 0, 0.05], [0.16, 0.03, 0.02], [seen(5)]) ]),
    stem(_, _).

test(taken_in_use, all(ID == [1])) :- on_table(mug), distinct(ID, taken_in_use(ID)).
test(pieces_of_one_thing, all(Pair == [0-1, 1-0])) :-
    sketch([ box([0, 0, 0], [0.1, 0.07, 0.07], []), box([0.1, 0, 0], [0.1, 0.065, 0.07], []),
             box([0.17, 0, 0], [0.04, 0.03, 0.03], []) ]),
    belongs_to(ID, Other), Pair = ID-Other.
test(apart_they_are_two_things, fail) :-
    sketch([ box([0, 0, 0], [0.1, 0.07, 0.07], []), box([0.2, 0, 0], [0.08, 0.065, 0.07], []) ]),
    belongs_to(_, _).
test(a_fragment_goes_with_the_body, all(ID == [0, 1])) :-
    sketch([ box([0, 0, 0.055], [0.066, 0.066, 0.11], [seen(1000)]),
             box([0.036, 0, 0.05], [0.004, 0.01, 0.03], [seen(3)]) ]),
    distinct(ID, taken_in_use(ID)).

:- end_tests(default_handles).
