:- use_module(measurement).
:- use_module(predicates).
:- use_module(sketch).
:- use_module(library(plunit)).

:- begin_tests(measurement, [setup(parts), cleanup(withdraw_parts)]).

parts :-
    withdraw_parts,
    state_part(0, [0, 0, 0], [0.1, 0.1, 0.1], [1.0, 1.0], sphere, 0.9),
    state_part(1, [0, 0, 0], [0.2, 0.1, 0.1], [1.0, 1.0], cylinder, 0.7).

near(A, B) :- abs(A - B) < 1.0e-9.

%   Value is what Goal on part ID is measured to have under Key.

measured(Goal, ID, Key, Value) :-
    measurement(Goal, ID, Measurement),
    get_dict(Key, Measurement, Value).

test(margin_is_the_tightest_dimension, true(near(Value, 0.01))) :-
    measured(min_dimension([0.3, 0.02, 0.05], [0.01, 0.02, 0.1]), 0, margin, Value).
test(margin_is_negative_outside, true(near(Value, -0.004))) :-
    measured(max_dimension([0.054, 0.03, 0.2], [0.05, 0.05, 1.0]), 0, margin, Value).
test(what_is_outside_is_named, true(Aspects == [width, length])) :-
    measured(max_dimension([0.3, 0.02, 0.4], [0.05, 0.1, 0.2]), 0, outside, Outside),
    findall(A, ( member(Out, Outside), get_dict(aspect, Out, A) ), Aspects).
test(a_lower_bound_of_zero_binds_nothing, true(Value == null)) :-
    measured(min_dimension([0.001, 0.001, 0.001], [0.0, 0, 0.0]), 0, margin, Value).
test(meeting_a_bound_exactly_is_even_odds, true(near(Value, 0.5))) :-
    measured(min_ratio([1.0, 1.0, 2.0], 2), 0, support, Value).
test(a_wide_margin_is_certain, true(Value > 0.99)) :-
    measured(max_ratio([1.0, 1.0, 2.0], 6), 0, support, Value).
test(volume_is_measured_against_the_other_parts, true(near(Value, 1.0))) :-
    measured(max_shape(1), 1, margin, Value).
test(not_the_largest, true(near(Value, -0.5))) :-
    measured(max_shape(0), 0, margin, Value).
test(not_the_smallest, true(near(Value, -1.0))) :-
    measured(min_shape(1), 1, margin, Value).
test(one_part_has_no_rival, [setup(one), cleanup(parts), true(Value == null)]) :-
    measured(max_shape(0), 0, margin, Value).

one :-
    withdraw_parts,
    state_part(0, [0, 0, 0], [0.1, 0.1, 0.1], [1.0, 1.0], sphere, 0.9).

test(shape_that_fits_has_the_classifiers_probability, true(near(Value, 0.9))) :-
    measured(sphere == sphere, 0, support, Value).
test(shape_that_does_not_fit_has_the_rest, true(near(Value, 0.1))) :-
    measured(sphere == cylinder, 0, support, Value).
test(one_of_several_shapes, true([S, R] == [0.7, [cuboid, cylinder]])) :-
    Goal = ( cylinder == cuboid ; cylinder == cylinder ),
    measured(Goal, 1, support, S),
    measured(Goal, 1, required, R).
test(what_has_no_scale_is_other, true(Value == other)) :-
    measured(member(1, [1]), 0, kind, Value).

%   Quantities (quantities.pl), on boxes 0.3 x 0.03 x 0.02 and 0.03 x 0.12 x 0.03 m.

hammer :-
    sketch([ box([0, 0, 0.02], [0.3, 0.03, 0.02], [holes(1)]), box([0.165, 0, 0.02], [0.03, 0.12, 0.03], []) ]).

test(margin_of_a_quantity, [setup(hammer), cleanup(wipe), true(near(Value, 0.01))]) :-
    measured(at_most(width(0), 0.04), 0, margin, Value).
test(margin_is_negative_outside, [setup(hammer), cleanup(wipe), true(near(Value, -0.01))]) :-
    measured(at_least(thickness(1), 0.04), 1, margin, Value).
test(measured_share, [setup(hammer), cleanup(wipe), true(near(Value, 0.25))]) :-
    measured(at_most(width(0) / across(1), 1), 0, measured, Value).
test(share_as_data, [setup(hammer), cleanup(wipe), true(Value == [share, [width, 0], [across, 1]])]) :-
    measured(at_most(width(0) / across(1), 1), 0, quantity, Value).
test(exactly_at_the_bound, [setup(hammer), cleanup(wipe), true(abs(Value - 0.5) < 1.0e-6)]) :-
    measured(at_least(width(0), 0.03), 0, support, Value).
test(a_count_at_its_bound_is_rather_sure, [setup(hammer), cleanup(wipe), true(Value > 0.9)]) :-
    measured(at_least(holes(0), 1), 0, support, Value).
test(no_excess_inside, [setup(hammer), cleanup(wipe), true(Value =:= 0)]) :-
    measured(at_most(width(0), 0.04), 0, excess, Value).
test(excess_grows, [setup(hammer), cleanup(wipe), true(Near < Far)]) :-
    measured(at_most(width(0), 0.025), 0, excess, Near),
    measured(at_most(width(0), 0.01), 0, excess, Far).
test(a_poor_fit_makes_it_less_sure, [setup(hammer), cleanup(wipe), true(Poor < Good)]) :-
    measured(at_most(width(0), 0.04), 0, support, Good),
    retract(quantities:residual(0, _)),
    assertz(quantities:residual(0, 0.01)),
    measured(at_most(width(0), 0.04), 0, support, Poor).
test(units, [setup(hammer), cleanup(wipe), true(Units == [m, ratio, deg, count, m3])]) :-
    findall(U, ( member(Q, [length(0), stretch(0), slant(0), holes(0), volume(0)]),
                 measured(at_least(Q, 0.0), 0, unit, U) ),
            Units).
test(what_is_not_known_has_no_scale, [setup(hammer), cleanup(wipe), true(Value == other)]) :-
    measured(at_least(width(7), 0.1), 7, kind, Value).
test(touching, [setup(hammer), cleanup(wipe), true(Value =:= 0)]) :-
    measured(meets(1, 0), 1, excess, Value).

:- end_tests(measurement).
