/*  What can be measured on the parts and between them, and bounds on it.

    The vocabulary that the rule set `default` has beside that of the thesis
    (predicates.pl). A rule names a quantity and a bound,

        at_most(thickness(ID), 0.06)
        at_least(stretch(ID) / stretch(ID_tool), 2)

    and the proof shows what was measured. One pair of predicates for every
    quantity, so that a rule reads the same whatever it asks for.

    The service computes how the parts lie (services/reasoning/layout.py) and
    states it here for one request; what follows from that is decided by the
    rules. The object's main axis is the longest principal axis of all parts
    together; lengths are metres, angles degrees.

        thickness(P), width(P), length(P)   dimensions of the part, ascending
        volume(P)                           what it encloses, cubic metres
        along(P), across(P)                 full extents along the object's main axis,
                                            and the larger of those across it
        stretch(P)                          along / across: elongation along the OBJECT
        slant(P)                            angle between the part's longest axis and the
                                            main axis, 0 to 90
        end_gap(P)                          distance from the nearer end of the object, as
                                            a share of its length; 0 for a part at an end
        reach(P, Q)                         how far P sticks out of Q, towards the side of
                                            Q on which P lies
        offset(P, Q)                        how far the centre of P lies from that of Q
                                            along the longest axis of Q, relative to half
                                            of Q's length: above 1 past its end
        likeness(P, Q)                      of two parts that meet: cross-section of the
                                            slimmer over that of the stouter, across the
                                            line that joins them; 1 where one goes on as
                                            the other ends
        filling(P, Q)                       of two parts that meet: how much of the box
                                            around both their own boxes fill
        bend(P, Q)                          of two parts that meet: angle between their
                                            longest axes, 0 to 90
        seen(P)                             share of the object's points that belong to P
        top(P), bottom(P)                   heights above the support plane, if one is known
        holes(P)                            openings through the part
        gripper_opening                     widest opening of the gripper that was asked
                                            for, if it is known
        object_length                       of the whole, along the main axis
        object_width                        the largest across(P)
        Q1 / Q2                             one quantity relative to another
*/

:- module(quantities,
          [ part/1,                     % ?ID
            at_least/2,                 % +Quantity, +Bound
            at_most/2,                  % +Quantity, +Bound
            meets/2,                    % ?ID, ?Other
            fits_gripper/1,             % ?ID
            quantity/3,                 % +Quantity, -Value, -Unit
            quantity_part/2,            % +Quantity, -ID
            known_quantity/1,           % @Quantity
            residual/2,                 % ?ID, ?Metres
            layout_fact/1,              % -Fact
            state_layout/1,             % +Layout
            withdraw_layout/0
          ]).
:- use_module(predicates).
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).

:- dynamic
    extents/4,                  % ID, Along, Across, Depth
    interval/3,                 % ID, From, To: along the main axis
    slant/2,                    % ID, Degrees
    beside/4,                   % ID, Other, Reach, Offset
    seen/2,                     % ID, Share
    stands/3,                   % ID, Bottom, Top
    holes/2,                    % ID, Count
    residual/2,                 % ID, Metres
    meeting/2,                  % ID, Other
    continuity/5,               % ID, Other, Likeness, Filling, Bend: of those that meet
    object_length/1,            % Metres
    gripper_opening/1.          % Metres

%!  part(?ID) is nondet.
%
%   A recovered part.

part(ID) :-
    primitive_values(ID, _, _, _, _).

%!  at_least(+Quantity, +Bound) is semidet.
%
%   Quantity is known and not below Bound.

at_least(Quantity, Bound) :-
    quantity(Quantity, Value, _),
    Value >= Bound.

%!  at_most(+Quantity, +Bound) is semidet.
%
%   Quantity is known and not above Bound.

at_most(Quantity, Bound) :-
    quantity(Quantity, Value, _),
    Value =< Bound.

%!  meets(?ID, ?Other) is nondet.
%
%   The two parts touch.

meets(ID, Other) :-
    meeting(ID, Other).
meets(ID, Other) :-
    meeting(Other, ID).

%!  fits_gripper(?ID) is nondet.
%
%   The part is thin enough to go between the fingers, on one side at least. Where no
%   opening is known, nothing speaks against any part.

fits_gripper(ID) :-
    part_size(ID, Thickness, _, _),
    \+ ( gripper_opening(Opening), Thickness > Opening ).

%!  quantity(+Quantity, -Value, -Unit) is semidet.
%
%   Unit is m, m3, deg, count or ratio. Fails for what is not known, such as a
%   height without a support plane.

quantity(One / Other, Value, ratio) :-
    !,
    quantity(One, V1, Unit),
    quantity(Other, V2, Unit),
    V2 > 0,
    Value is V1 / V2.
quantity(thickness(ID), Value, m) :- part_size(ID, Value, _, _).
quantity(width(ID), Value, m) :- part_size(ID, _, Value, _).
quantity(length(ID), Value, m) :- part_size(ID, _, _, Value).
quantity(volume(ID), Value, m3) :- volume(ID, Value).
quantity(along(ID), Value, m) :- extents(ID, Value, _, _).
quantity(across(ID), Value, m) :- extents(ID, _, Across, Depth), Value is max(Across, Depth).
quantity(stretch(ID), Value, ratio) :-
    extents(ID, Along, Across, Depth),
    Value is Along / max(Across, Depth).
quantity(slant(ID), Value, deg) :- slant(ID, Value).
quantity(end_gap(ID), Value, ratio) :-
    interval(ID, From, To),
    object_length(Length),
    Value is max(0.0, min(From, Length - To) / Length).
quantity(reach(ID, Other), Value, m) :- beside(ID, Other, Value, _).
quantity(offset(ID, Other), Value, ratio) :- beside(ID, Other, _, Value).
quantity(likeness(ID, Other), Value, ratio) :- passing(ID, Other, Value, _, _).
quantity(filling(ID, Other), Value, ratio) :- passing(ID, Other, _, Value, _).
quantity(bend(ID, Other), Value, deg) :- passing(ID, Other, _, _, Value).
quantity(seen(ID), Value, ratio) :- seen(ID, Value).
quantity(bottom(ID), Value, m) :- stands(ID, Value, _).
quantity(top(ID), Value, m) :- stands(ID, _, Value).
quantity(holes(ID), Value, count) :- holes(ID, Value).
quantity(gripper_opening, Value, m) :- gripper_opening(Value).
quantity(object_length, Value, m) :- object_length(Value).
quantity(object_width, Value, m) :-
    aggregate_all(max(Width), quantity(across(_), Width, m), Value).

passing(ID, Other, Likeness, Filling, Bend) :-
    (   continuity(ID, Other, Likeness, Filling, Bend)
    ->  true
    ;   continuity(Other, ID, Likeness, Filling, Bend)
    ).

%!  quantity_part(+Quantity, -ID) is semidet.
%
%   The part that Quantity is about: the first that it names.

quantity_part(One / Other, ID) :-
    !,
    (   quantity_part(One, ID)
    ->  true
    ;   quantity_part(Other, ID)
    ).
quantity_part(Quantity, ID) :-
    compound(Quantity),
    arg(1, Quantity, ID),
    integer(ID).

%!  known_quantity(@Quantity) is semidet.
%
%   Quantity is one of those above. Tells a rule's spelling mistake from a
%   value that is not known.

known_quantity(One / Other) :-
    !,
    known_quantity(One),
    known_quantity(Other).
known_quantity(Quantity) :-
    callable(Quantity),
    functor(Quantity, Name, Arity),
    functor(General, Name, Arity),
    General \= _ / _,
    clause(quantity(General, _, _), _),
    !.

                /*******************************
                *        ONE REQUEST           *
                *******************************/

%!  layout_fact(-Fact) is nondet.
%
%   What is stated about how the parts lie.

layout_fact(Fact) :-
    member(Fact, [ object_length(_), gripper_opening(_), extents(_, _, _, _), interval(_, _, _), slant(_, _),
                   beside(_, _, _, _), stands(_, _, _), holes(_, _), seen(_, _), residual(_, _),
                   meeting(_, _), continuity(_, _, _, _, _) ]),
    call(Fact).

%!  state_layout(+Layout) is det.
%
%   Tell the rules how the parts lie: a dict of length, parts, pairs, meeting and the
%   gripper's opening (null if it is not known).

state_layout(Layout) :-
    (   get_dict(opening, Layout, Opening),
        number(Opening)
    ->  assertz(gripper_opening(Opening))
    ;   true
    ),
    assertz(object_length(Layout.length)),
    maplist(state_lie, Layout.parts),
    forall(member([ID, Other, Reach, Offset], Layout.pairs),
           assertz(beside(ID, Other, Reach, Offset))),
    forall(member([ID, Other, Likeness, Filling, Bend], Layout.meeting),
           ( assertz(meeting(ID, Other)),
             assertz(continuity(ID, Other, Likeness, Filling, Bend)) )).

state_lie(Part) :-
    ID = Part.id,
    [Along, Across, Depth] = Part.extents,
    [From, To] = Part.interval,
    assertz(extents(ID, Along, Across, Depth)),
    assertz(interval(ID, From, To)),
    assertz(slant(ID, Part.slant)),
    assertz(holes(ID, Part.holes)),
    assertz(seen(ID, Part.seen)),
    assertz(residual(ID, Part.residual)),
    (   [Bottom, Top] = Part.heights
    ->  assertz(stands(ID, Bottom, Top))
    ;   true
    ).

%!  withdraw_layout is det.

withdraw_layout :-
    retractall(extents(_, _, _, _)),
    retractall(interval(_, _, _)),
    retractall(slant(_, _)),
    retractall(beside(_, _, _, _)),
    retractall(seen(_, _)),
    retractall(stands(_, _, _)),
    retractall(holes(_, _)),
    retractall(residual(_, _)),
    retractall(meeting(_, _)),
    retractall(continuity(_, _, _, _, _)),
    retractall(object_length(_)),
    retractall(gripper_opening(_)).
