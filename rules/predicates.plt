:- use_module(predicates).
:- use_module(library(plunit)).

:- begin_tests(predicates, [cleanup(withdraw_parts)]).

parts :-
    withdraw_parts,
    state_part(0, [0, 0, 0.7], [0.18, 0.06, 0.18], [0.1, 1.0], cylinder, 0.9),
    state_part(1, [0, 0, 0.7], [0.02, 0.2, 0.03], [0.1, 0.1], cuboid, 0.8).

test(short_form, [setup(parts), true(Found == [0-cylinder, 1-cuboid])]) :-
    findall(ID-Shape, primitive_values(ID, _, Shape), Found).

test(min_dimension_sorts_the_dimensions) :-
    min_dimension([0.3, 0.01, 0.2], [0.01, 0.2, 0.3]).
test(min_dimension_compares_each_value, fail) :-
    min_dimension([1.0, 0.009, 1.0], [0.01, 0.0, 0.0]).
test(max_dimension_sorts_the_dimensions) :-
    max_dimension([0.3, 0.01, 0.2], [0.01, 0.2, 0.3]).
test(max_dimension_compares_each_value, fail) :-
    max_dimension([0.01, 0.01, 0.31], [1, 1, 0.3]).
test(bound_of_two_values_is_an_error, error(type_error(list_of_three_numbers, [1, 2]))) :-
    min_dimension([0.1, 0.1, 0.1], [1, 2]).

test(min_ratio) :- min_ratio([0.02, 0.05, 0.1], 5).
test(min_ratio, fail) :- min_ratio([0.021, 0.05, 0.1], 5).
test(max_ratio) :- max_ratio([0.02, 0.05, 0.1], 5).
test(max_ratio, fail) :- max_ratio([0.019, 0.05, 0.1], 5).

%   The short form says what the condition says, on either side of each bound.

test(by_size_is_the_condition,
     [forall(( member(Dim, [[0.1, 0.02, 0.05], [0.02, 0.02, 0.02], [0.3, 0.2, 0.1]]),
               ( member(Name, [min_dimension, max_dimension]),
                 member(Bound, [[0.02, 0.05, 0.1], [0.03, 0.0, 0.0], [0.0, 0.1, 0.2], [0.02, 0.02, 0.4]])
               ; member(Name, [min_ratio, max_ratio]),
                 member(Bound, [1, 3, 5, 6]) ) ))]) :-
    Condition =.. [Name, Dim, Bound],
    sorted_dimensions(Dim, [T, W, L]),
    by_size(Condition, size(T, W, L), Comparison),
    ( call(Condition) -> call(Comparison) ; \+ call(Comparison) ).

test(max_shape_is_the_largest_volume, [setup(parts), all(ID == [0])]) :- max_shape(ID).
test(min_shape_is_the_smallest_volume, [setup(parts), all(ID == [1])]) :- min_shape(ID).
test(equal_volumes_all_hold, [setup(twins), all(ID == [0, 1])]) :- max_shape(ID).

twins :-
    withdraw_parts,
    state_part(0, [0, 0, 0], [0.1, 0.1, 0.1], [1.0, 1.0], sphere, 1.0),
    state_part(1, [1, 0, 0], [0.1, 0.1, 0.1], [1.0, 1.0], sphere, 1.0).

%   An ellipsoid encloses pi/6 of its box, a box-like part nearly all of it.

test(volume_of_an_ellipsoid, [setup(twins), true(abs(Volume - pi/6*0.001) < 1.0e-12)]) :-
    once(volume(0, Volume)).
test(volume_of_a_cuboid, [setup(cuboid), true(abs(Volume - 0.006) < 0.0001)]) :-
    once(volume(0, Volume)).

cuboid :-
    withdraw_parts,
    state_part(0, [0, 0, 0], [0.1, 0.2, 0.3], [0.02, 0.02], cuboid, 1.0).

test(withdrawn_parts_are_gone, [setup(parts), fail]) :-
    withdraw_parts,
    (   primitive_values(_, _, _)
    ;   shape_probability(_, _)
    ).

:- end_tests(predicates).
