/*  What the rules may say about the recovered parts.

    The vocabulary of the thesis (chapter 5.2, code listings 5.1 to 5.4 and
    A.1, A.2), shared by every rule set. Facts about the parts hold for one
    request only; service.pl states them before the rules run and withdraws
    them after.

    Lengths are metres. Dimensions are FULL extents (2a), and every predicate
    that compares dimensions first sorts them ascending: [thickness, width,
    length].
*/

:- module(predicates,
          [ primitive_values/3,         % ?ID, ?Dimensions, ?ShapeClass
            primitive_values/5,         % ?ID, ?Position, ?Dimensions, ?Exponents, ?ShapeClass
            shape_probability/2,        % ?ID, ?Probability
            min_dimension/2,            % +Dimensions, +Minimum
            max_dimension/2,            % +Dimensions, +Maximum
            min_ratio/2,                % +Dimensions, +Minimum
            max_ratio/2,                % +Dimensions, +Maximum
            max_shape/1,                % ?ID
            min_shape/1,                % ?ID
            by_size/3,                  % +Condition, +Size, -Comparison
            sorted_dimensions/2,        % +Dimensions, -Ascending
            part_size/4,                % ?ID, ?Thickness, ?Width, ?Length
            ratio/2,                    % +Dimensions, -Ratio
            volume/2,                   % ?ID, ?Volume
            bound/1,                    % @Term
            state_part/6,               % +ID, +Position, +Dimensions, +Exponents, +Shape, +Probability
            withdraw_parts/0
          ]).
:- use_module(library(error)).
:- use_module(library(lists)).
:- use_module(library(apply)).

%!  primitive_values(?ID, ?Position, ?Dimensions, ?Exponents, ?ShapeClass) is nondet.
%
%   A part: its number, centre [X,Y,Z], full extents [D1,D2,D3], exponents
%   [E1,E2] and class (cuboid, cylinder or sphere). The form of A.2.

:- dynamic primitive_values/5.

%!  shape_probability(?ID, ?Probability) is nondet.
%
%   How sure the classifier is of the part's class, 0 to 1.

:- dynamic shape_probability/2.

%!  part_size(?ID, ?Thickness, ?Width, ?Length) is nondet.
%
%   The part's dimensions, ascending; they are asked for so often that they are stated.

:- dynamic part_size/4.

%!  volume(?ID, ?Volume) is nondet.
%
%   What the part encloses, in cubic metres; stated for the same reason.

:- dynamic volume/2.

%!  primitive_values(?ID, ?Dimensions, ?ShapeClass) is nondet.
%
%   The same part in the short form of chapter 5.

primitive_values(ID, Dimensions, ShapeClass) :-
    primitive_values(ID, _, Dimensions, _, ShapeClass).

%!  min_dimension(+Dimensions, +Minimum) is semidet.
%
%   The sorted dimensions are at least the three values of Minimum, one by one.

min_dimension(Dimensions, Minimum) :-
    bounds(Minimum, LeastThickness, LeastWidth, LeastLength),
    sorted_dimensions(Dimensions, [Thickness, Width, Length]),
    Thickness >= LeastThickness,
    Width >= LeastWidth,
    Length >= LeastLength.

%!  max_dimension(+Dimensions, +Maximum) is semidet.
%
%   The sorted dimensions are at most the three values of Maximum, one by one.

max_dimension(Dimensions, Maximum) :-
    bounds(Maximum, MostThickness, MostWidth, MostLength),
    sorted_dimensions(Dimensions, [Thickness, Width, Length]),
    Thickness =< MostThickness,
    Width =< MostWidth,
    Length =< MostLength.

%!  min_ratio(+Dimensions, +Minimum) is semidet.
%
%   The largest dimension is at least Minimum times the smallest: elongated.

min_ratio(Dimensions, Minimum) :-
    ratio(Dimensions, Ratio),
    Ratio >= Minimum.

%!  max_ratio(+Dimensions, +Maximum) is semidet.
%
%   The largest dimension is at most Maximum times the smallest: compact.

max_ratio(Dimensions, Maximum) :-
    ratio(Dimensions, Ratio),
    Ratio =< Maximum.

%!  by_size(+Condition, +Size, -Comparison) is semidet.
%
%   What a condition on a part's dimensions comes to where its size(Thickness, Width,
%   Length) is known, for rules that are asked about every part of every request.

by_size(min_dimension(_, [A, B, C]), size(T, W, L), (T >= A, W >= B, L >= C)).
by_size(max_dimension(_, [A, B, C]), size(T, W, L), (T =< A, W =< B, L =< C)).
by_size(min_ratio(_, Minimum), size(T, _, L), L / T >= Minimum).
by_size(max_ratio(_, Maximum), size(T, _, L), L / T =< Maximum).

%!  max_shape(?ID) is nondet.
%
%   No other part encloses a larger volume. Parts of equal volume all hold.

max_shape(ID) :-
    volume(ID, Volume),
    \+ ( volume(_, Other), Other > Volume ).

%!  min_shape(?ID) is nondet.
%
%   No other part encloses a smaller volume. Parts of equal volume all hold.

min_shape(ID) :-
    volume(ID, Volume),
    \+ ( volume(_, Other), Other < Volume ).

%!  sorted_dimensions(+Dimensions, -Ascending) is det.

sorted_dimensions(Dimensions, Ascending) :-
    msort(Dimensions, Ascending).

%!  ratio(+Dimensions, -Ratio) is det.
%
%   Largest over smallest dimension, at least 1.

ratio(Dimensions, Ratio) :-
    sorted_dimensions(Dimensions, [Smallest, _, Largest]),
    Ratio is Largest / Smallest.

%   What a superquadric encloses, in cubic metres: a cylinder fills less of its box than
%   a cuboid. Jaklic, Leonardis, Solina (2000), Eq. 2.60, with a1 a2 a3 = D1 D2 D3 / 8.

enclosed([D1, D2, D3], [E1, E2], Volume) :-
    Volume is D1 * D2 * D3 / 4 * E1 * E2
              * exp(lgamma(E1/2 + 1) + lgamma(E1) - lgamma(3*E1/2 + 1))
              * exp(2 * lgamma(E2/2) - lgamma(E2)).

%!  bound(@Term) is semidet.
%
%   Term is a bound on dimensions: three numbers.

bound(Term) :-
    is_list(Term),
    Term = [Thickness, Width, Length],
    number(Thickness),
    number(Width),
    number(Length).

bounds([Thickness, Width, Length], Thickness, Width, Length) :-
    number(Thickness),
    number(Width),
    number(Length),
    !.
bounds(Term, _, _, _) :-
    type_error(list_of_three_numbers, Term).

%!  state_part(+ID, +Position, +Dimensions, +Exponents, +ShapeClass, +Probability) is det.
%
%   Tell the rules of a part.

state_part(ID, Position, Dimensions, Exponents, ShapeClass, Probability) :-
    assertz(primitive_values(ID, Position, Dimensions, Exponents, ShapeClass)),
    sorted_dimensions(Dimensions, [Thickness, Width, Length]),
    assertz(part_size(ID, Thickness, Width, Length)),
    enclosed(Dimensions, Exponents, Volume),
    assertz(volume(ID, Volume)),
    assertz(shape_probability(ID, Probability)).

%!  withdraw_parts is det.
%
%   Forget every part.

withdraw_parts :-
    retractall(primitive_values(_, _, _, _, _)),
    retractall(part_size(_, _, _, _)),
    retractall(volume(_, _)),
    retractall(shape_probability(_, _)).
