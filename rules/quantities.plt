:- use_module(quantities).
:- use_module(sketch).
:- use_module(library(plunit)).

:- begin_tests(quantities, [setup(hammer), cleanup(wipe)]).

%   A handle along x, and a head across it at its end.

hammer :-
    sketch([ box([0, 0, 0.02], [0.3, 0.04, 0.02], []),
             box([0.165, 0, 0.02], [0.03, 0.1, 0.03], [holes(2)]) ]).

near(A, B) :- abs(A - B) < 1.0e-9.

of(Quantity, Value) :- quantity(Quantity, Value, _).

test(thickness, true(near(V, 0.02))) :- of(thickness(0), V).
test(width, true(near(V, 0.04))) :- of(width(0), V).
test(length, true(near(V, 0.3))) :- of(length(0), V).
test(along, true(near(V, 0.03))) :- of(along(1), V).
test(across, true(near(V, 0.1))) :- of(across(1), V).
test(stretch_of_a_handle, true(near(V, 7.5))) :- of(stretch(0), V).
test(stretch_across_the_object, true(near(V, 0.3))) :- of(stretch(1), V).
test(slant, true(V =:= 90)) :- of(slant(1), V).
test(end_gap, true(near(V, 0))) :- of(end_gap(0), V).
test(top, true(near(V, 0.03))) :- of(top(0), V).
test(bottom, true(near(V, 0.005))) :- of(bottom(1), V).
test(holes, true(V == 2)) :- of(holes(1), V).
test(object_length, true(near(V, 0.33))) :- of(object_length, V).
test(object_width, true(near(V, 0.1))) :- of(object_width, V).
test(volume_unit, true(Unit == m3)) :- quantity(volume(0), _, Unit).
test(share, true(near(V, 0.4))) :- of(across(0) / across(1), V).
test(share_of_another_kind, true(near(V, 3 / 33))) :- of(along(1) / object_length, V).
test(metres_are_not_shares, fail) :- of(width(0) / stretch(0), _).
test(unknown_part, fail) :- of(width(7), _).

test(at_least, all(ID == [0])) :- part(ID), at_least(length(ID), 0.2).
test(at_most, all(ID == [1])) :- part(ID), at_most(length(ID), 0.2).
test(a_bound_is_met_exactly) :- at_least(holes(1), 2), at_most(holes(1), 2).

test(part_of_a_quantity, true(ID == 1)) :- quantity_part(width(1) / width(0), ID).
test(part_of_the_other, true(ID == 0)) :- quantity_part(object_length / width(0), ID).
test(no_part, fail) :- quantity_part(object_length, _).

test(known) :- known_quantity(stretch(_) / stretch(_)).
test(misspelt, fail) :- known_quantity(strech(_)).
test(misspelt_share, fail) :- known_quantity(width(_) / wdth(_)).

test(no_table_no_height, fail) :-
    withdraw_layout,
    state_layout(layout{length: 1, meeting: [], pairs: [],
                        parts: [lie{id: 0, extents: [1, 1, 1], interval: [0, 1], slant: 0, holes: 0,
                                    seen: 1, residual: 0, heights: null}]}),
    of(top(0), _).
test(withdrawn, [setup(hammer), fail]) :-
    withdraw_layout,
    layout_fact(_).

:- end_tests(quantities).
