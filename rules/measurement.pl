/*  The numbers behind a condition: what was measured, what was required, by how
    much it holds or fails, and how far that can be trusted.

    Trust. A recovered part is not known exactly. A condition's support is the
    probability that it holds on the true part, if the measured value has a
    normal error with the spread assumed here:

        dimensions   2 mm (depth noise) plus 10 % of the bound (recovery)
        ratio        15 % of the bound (two dimensions, each 10 %)
        volume       20 % (three dimensions, each 10 %)
        quantity     (quantities.pl) 2 mm, or what the part's fit leaves if that
                     is more, plus 10 % for a length, 15 % for a ratio, 20 % for
                     a volume, 10 degrees for an angle, and a third of a count
                     about the step between two counts

    and, for a shape class, the classifier's own probability. These spreads are
    assumptions, not a calibration; they order parts and say which condition was
    a close call. A condition that exactly meets its bound has support 0.5.

    The excess of a condition that fails is its distance from the bound in those
    spreads; a wrong shape counts 3 times the probability of the class found.
*/

:- module(measurement,
          [ measurement/3,              % +Goal, +ID, -Measurement
            bound_excess/2              % +Goal, -Excess
          ]).
:- use_module(predicates).
:- use_module(quantities).
:- use_module(library(apply)).
:- use_module(library(lists)).

%!  measurement(+Goal, +ID, -Measurement) is det.
%
%   Measurement is a dict about the condition Goal on part ID, whether it holds
%   or not: kind, measured, required, margin (in unit; negative outside), unit,
%   support, excess, and for dimensions which of them are out of bounds. A goal
%   that has no scale is of the kind other.

measurement(Goal, ID, Measurement) :-
    (   measure(Goal, ID, Found)
    ->  Measurement = Found
    ;   Measurement = m{kind: other, measured: null, required: null, margin: null, unit: null,
                        support: null, excess: 0.0, outside: []}
    ).

measure(min_dimension(Dimensions, Minimum), _, M) :-
    measure_dimensions(min_dimension, Dimensions, Minimum, M).
measure(max_dimension(Dimensions, Maximum), _, M) :-
    measure_dimensions(max_dimension, Dimensions, Maximum, M).
measure(min_ratio(Dimensions, Minimum), _, M) :-
    ratio(Dimensions, Ratio),
    Margin is Ratio - Minimum,
    Spread is 0.15 * Minimum,
    on_a_scale(min_ratio, Ratio, Minimum, Margin, ratio, Spread, M).
measure(max_ratio(Dimensions, Maximum), _, M) :-
    ratio(Dimensions, Ratio),
    Margin is Maximum - Ratio,
    Spread is 0.15 * Maximum,
    on_a_scale(max_ratio, Ratio, Maximum, Margin, ratio, Spread, M).
measure(max_shape(ID), _, M) :-
    measure_volume(max_shape, max_list, ID, M).
measure(min_shape(ID), _, M) :-
    measure_volume(min_shape, min_list, ID, M).
measure(Found == Class, ID, M) :-
    measure_shape(Found, [Class], ID, M).
measure((A ; B), ID, M) :-
    alternatives((A ; B), Found, Classes),
    measure_shape(Found, Classes, ID, M).
measure(at_least(Quantity, Bound), _, M) :-
    measure_quantity(at_least(Quantity, Bound), M).
measure(at_most(Quantity, Bound), _, M) :-
    measure_quantity(at_most(Quantity, Bound), M).
measure(meets(A, B), _, M) :-
    integer(A),
    integer(B),
    ( meets(A, B) -> Excess = 0.0 ; Excess = 1.0 ),
    M = m{kind: meets, measured: [A, B], required: null, margin: null, unit: null,
          support: null, excess: Excess, outside: []}.
measure(fits_gripper(ID), _, M) :-
    integer(ID),
    quantity(thickness(ID), Thickness, m),
    (   quantity(gripper_opening, Opening, m)
    ->  Margin is Opening - Thickness,
        quantity_spread(m, thickness(ID), Thickness, Spread),
        on_a_scale(fits_gripper, Thickness, Opening, Margin, m, Spread, M)
    ;   M = m{kind: fits_gripper, measured: Thickness, required: null, margin: null, unit: m,
              support: null, excess: 0.0, outside: []}
    ).
measure(A \= B, _, M) :-
    integer(A),
    integer(B),
    (   A =:= B
    ->  Support = 0.0, Excess = 1.0
    ;   Support = 1.0, Excess = 0.0
    ),
    M = m{kind: distinct, measured: [A, B], required: null, margin: null, unit: null,
          support: Support, excess: Excess, outside: []}.

%   Dimensions: the margin is that of the tightest of the three. A lower bound of
%   zero binds nothing and is left out.

measure_dimensions(Kind, Dimensions, Bound, M) :-
    bound(Bound),
    sorted_dimensions(Dimensions, Sorted),
    foldl(slack(Kind), [thickness, width, length], Sorted, Bound, Slacks, []),
    foldl(tightest, Slacks, s(null, null, 0.0, []), s(Margin, Support, Excess, Outside)),
    reverse(Outside, InOrder),
    M = m{kind: Kind, measured: Sorted, required: Bound, margin: Margin, unit: m,
          support: Support, excess: Excess, outside: InOrder}.

slack(min_dimension, _, _, Bound, Slacks, Slacks) :-
    Bound =< 0,
    !.
slack(Kind, Aspect, Found, Bound, [slack(Aspect, Found, Bound, Margin, Spreads)|Rest], Rest) :-
    (   Kind == min_dimension
    ->  Margin is Found - Bound
    ;   Margin is Bound - Found
    ),
    Spreads is Margin / (0.002 + 0.1 * Bound).

tightest(slack(Aspect, Found, Bound, Margin, Spreads), s(M0, S0, E0, O0), s(M, S, E, O)) :-
    normal(Spreads, Support),
    least(M0, Margin, M),
    least(S0, Support, S),
    (   Margin < 0
    ->  E is E0 - Spreads,
        By is -Margin,
        O = [out{aspect: Aspect, measured: Found, required: Bound, by: By}|O0]
    ;   E = E0,
        O = O0
    ).

least(null, New, New) :- !.
least(Old, New, Least) :-
    Least is min(Old, New).

%   Volume: against the largest (smallest) of the other parts. Without another
%   part there is nothing to compare.

measure_volume(Kind, Extreme, ID, M) :-
    volume(ID, Volume),
    findall(V, ( volume(Other, V), Other \== ID ), Others),
    (   Others == []
    ->  M = m{kind: Kind, measured: Volume, required: null, margin: null, unit: null,
              support: null, excess: 0.0, outside: []}
    ;   call(Extreme, Others, Rival),
        (   Kind == max_shape
        ->  Margin is Volume / Rival - 1
        ;   Margin is 1 - Volume / Rival
        ),
        on_a_scale(Kind, Volume, Rival, Margin, ratio, 0.2, M)
    ).

%   Shape: the class found against those allowed.

alternatives((A ; B), Found, Classes) :-
    !,
    alternatives(A, Found, First),
    alternatives(B, Same, Rest),
    Found == Same,
    append(First, Rest, Classes).
alternatives(Found == Class, Found, [Class]).

measure_shape(Found, Classes, ID, M) :-
    memberchk(Found, [cuboid, cylinder, sphere]),
    shape_probability(ID, Probability),
    (   memberchk(Found, Classes)
    ->  Support = Probability, Excess = 0.0
    ;   Support is 1 - Probability, Excess is 3 * Probability
    ),
    M = m{kind: shape, measured: Found, required: Classes, margin: null, unit: null,
          support: Support, excess: Excess, outside: []}.

%   Quantities: outside tells which, in words of the quantity.

measure_quantity(Goal, M) :-
    compared(Goal, Quantity, Bound, Value, Unit, Margin, Spreads),
    functor(Goal, Kind, _),
    normal(Spreads, Support),
    quantity_excess(Margin, Spreads, Excess),
    described(Quantity, Described),
    M = m{kind: Kind, measured: Value, required: Bound, margin: Margin, unit: Unit,
          support: Support, excess: Excess, outside: [], quantity: Described}.

%!  bound_excess(+Goal, -Excess) is semidet.
%
%   The excess of a bound on a quantity, as in its measurement.

bound_excess(Goal, Excess) :-
    compared(Goal, _, _, _, _, Margin, Spreads),
    quantity_excess(Margin, Spreads, Excess).

compared(at_least(Quantity, Bound), Quantity, Bound, Value, Unit, Margin, Spreads) :-
    quantity(Quantity, Value, Unit),
    number(Bound),
    Margin is Value - Bound,
    in_spreads(Unit, Quantity, Bound, Margin, Spreads).
compared(at_most(Quantity, Bound), Quantity, Bound, Value, Unit, Margin, Spreads) :-
    quantity(Quantity, Value, Unit),
    number(Bound),
    Margin is Bound - Value,
    in_spreads(Unit, Quantity, Bound, Margin, Spreads).

in_spreads(Unit, Quantity, Bound, Margin, Spreads) :-
    quantity_spread(Unit, Quantity, Bound, Spread),
    ( Unit == count -> Slack is Margin + 0.5 ; Slack = Margin ),
    Spreads is Slack / Spread.

quantity_excess(Margin, Spreads, Excess) :-
    ( Margin < 0 -> Excess is max(0.0, -Spreads) ; Excess = 0.0 ).

quantity_spread(m, Quantity, Bound, Spread) :-
    (   quantity_part(Quantity, ID),
        residual(ID, Residual)
    ->  true
    ;   Residual = 0.0
    ),
    Spread is max(0.002, Residual) + 0.1 * abs(Bound).
quantity_spread(ratio, _, Bound, Spread) :-
    Spread is 0.02 + 0.15 * abs(Bound).
quantity_spread(m3, _, Bound, Spread) :-
    Spread is max(1.0e-9, 0.2 * abs(Bound)).
quantity_spread(deg, _, _, 10.0).
quantity_spread(count, _, _, 0.33).

%   A quantity as data: its name and parts, or two of them for a share.

described(One / Other, [share, First, Second]) :-
    !,
    described(One, First),
    described(Other, Second).
described(Quantity, [Name|Parts]) :-
    Quantity =.. [Name|Parts].

on_a_scale(Kind, Found, Bound, Margin, Unit, Spread, M) :-
    Spreads is Margin / Spread,
    normal(Spreads, Support),
    Excess is max(0.0, -Spreads),
    M = m{kind: Kind, measured: Found, required: Bound, margin: Margin, unit: Unit,
          support: Support, excess: Excess, outside: []}.

%   Standard normal distribution function.

normal(Z, Probability) :-
    Probability is 0.5 * (1 + erf(Z / sqrt(2))).
