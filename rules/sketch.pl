/*  An object drawn of boxes: for the tests of rules, and for trying a rule at the
    prompt.

        ?- use_module(default/version1), use_module(sketch),
           sketch([box([0, 0, 0], [0.2, 0.2, 0.06], []), box([0.2, 0, 0], [0.2, 0.03, 0.02], [])]),
           affordTask(ID, cooking).
        ID = 1.

    The boxes lie along the axes, and x is the object's main axis. What the service
    measures on recovered parts (services/reasoning/layout.py) is worked out for
    them here.
*/

:- module(sketch, [sketch/1, wipe/0]).          % +Boxes
:- use_module(predicates).
:- use_module(quantities).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(option)).

%!  sketch(+Boxes) is det.
%
%   State the parts of an object, numbered from 0, in place of those stated before.
%   Each is box(Centre, Size, Options): [X,Y,Z] and full extents along x, y and z in
%   metres, with the options shape(Class) (cylinder), holes(Count) (0) and
%   seen(Weight) (1).

sketch(Boxes) :-
    wipe,
    length(Boxes, Number),
    numlist(1, Number, FromOne),
    maplist([N, ID]>>(ID is N - 1), FromOne, IDs),
    maplist(state_box, IDs, Boxes),
    findall(Low, ( member(box([X, _, _], [DX, _, _], _), Boxes), Low is X - DX / 2 ), Lows),
    findall(High, ( member(box([X, _, _], [DX, _, _], _), Boxes), High is X + DX / 2 ), Highs),
    min_list(Lows, Start),
    max_list(Highs, End),
    Length is End - Start,
    foldl([box(_, _, O), S0, S]>>( option(seen(W), O, 1), S is S0 + W ), Boxes, 0, Seen),
    maplist(lie(Start, Seen), IDs, Boxes, Lies),
    findall([ID, Other, Reach, Offset],
            ( nth0(ID, Boxes, One), nth0(Other, Boxes, Two), ID \== Other,
              reach(One, Two, Reach), offset(One, Two, Offset) ),
            Pairs),
    findall([ID, Other, Likeness, Filling, Bend],
            ( nth0(ID, Boxes, One), nth0(Other, Boxes, Two), ID < Other, meet(One, Two),
              continuity(One, Two, Likeness, Filling), bend(One, Two, Bend) ),
            Meeting),
    state_layout(layout{length: Length, parts: Lies, pairs: Pairs, meeting: Meeting}).

%!  wipe is det.
%
%   Forget the object.

wipe :-
    withdraw_parts,
    withdraw_layout.

state_box(ID, box(Centre, Size, Options)) :-
    option(shape(Shape), Options, cylinder),
    state_part(ID, Centre, Size, [0.1, 0.1], Shape, 0.95).

lie(Start, Seen, ID, box([X, _, Z], Size, Options), Lie) :-
    Size = [DX, _, DZ],
    sorted_dimensions(Size, [_, Width, Longest]),
    maplist([D, E]>>(E is max(D, Width / 2)), Size, Extents),
    From is X - DX / 2 - Start,
    To is From + DX,
    Bottom is Z - DZ / 2,
    Top is Z + DZ / 2,
    ( DX >= Longest -> Slant = 0.0 ; Slant = 90.0 ),
    option(holes(Holes), Options, 0),
    option(seen(Weight), Options, 1),
    Share is Weight / Seen,
    Lie = lie{id: ID, extents: Extents, interval: [From, To], slant: Slant, holes: Holes,
              seen: Share, residual: 0.001, heights: [Bottom, Top]}.

reach(box(C1, S1, _), box(C2, S2, _), Reach) :-
    maplist([A, B, D]>>(D is A - B), C1, C2, Apart),
    foldl([D, Q0, Q]>>(Q is Q0 + D * D), Apart, 0, Square),
    Distance is max(1.0e-9, sqrt(Square)),
    foldl([D, A, B, R0, R]>>(R is R0 + abs(D) / Distance * (A - B) / 2), Apart, S1, S2, 0, More),
    Reach is Distance + More.

offset(box(C1, _, _), box(C2, S2, _), Offset) :-
    max_list(S2, Longest),
    nth0(Axis, S2, Longest),
    !,
    nth0(Axis, C1, A),
    nth0(Axis, C2, B),
    Offset is 2 * abs(A - B) / Longest.

meet(box(C1, S1, _), box(C2, S2, _)) :-
    maplist([A, B, D1, D2]>>(abs(A - B) =< (D1 + D2) / 2 + 0.006), C1, C2, S1, S2).

%   By the edges along each axis: from(A, B) of the one, from(C, D) of the other.

continuity(box(C1, S1, _), box(C2, S2, _), Likeness, Filling) :-
    maplist(edges, C1, S1, Edges1),
    maplist(edges, C2, S2, Edges2),
    maplist(gap, Edges1, Edges2, Gaps),
    max_list(Gaps, Widest),
    nth0(Axis, Gaps, Widest),
    !,
    findall(Ratio,
            ( nth0(K, S1, D1), K \== Axis, nth0(K, S2, D2), Ratio is min(D1, D2) / max(D1, D2) ),
            Ratios),
    min_list(Ratios, Likeness),
    maplist(span, Edges1, Edges2, Common),
    maplist(product, [S1, S2, Common], [V1, V2, Around]),
    Filling is (V1 + V2) / Around.

edges(Centre, Size, from(Low, High)) :-
    Low is Centre - Size / 2,
    High is Centre + Size / 2.

gap(from(A, B), from(C, D), Gap) :-
    Gap is max(C - B, A - D).

span(from(A, B), from(C, D), Span) :-
    Span is max(B, D) - min(A, C).

product(Numbers, Product) :-
    foldl([N, P0, P]>>(P is P0 * N), Numbers, 1, Product).

bend(box(_, S1, _), box(_, S2, _), Bend) :-
    longest(S1, Axis1),
    longest(S2, Axis2),
    ( Axis1 == Axis2 -> Bend = 0.0 ; Bend = 90.0 ).

longest(Size, Axis) :-
    max_list(Size, Longest),
    nth0(Axis, Size, Longest),
    !.
