/*  Proving rules so that the proof can be shown.

    The body of a rule (reading.pl) is proved step by step by calling each goal
    itself; every condition is recorded with what was measured.

    proof/3     gives the ways in which a rule holds, as Prolog finds them.
    attempt/3   tries a rule on every choice of parts and lets no condition cut
                the rest off; it serves to find the nearest miss.

    A negation is a condition too; the reason is the nearest miss of what it
    denies.

    Rules that are learned at run time (learned.pl) are proved beside those of a
    module: the hooks further_rule/6 and further_part/2 give them.
*/

:- module(explain,
          [ holds_for_part/2,           % +Module, ?Head
            steps_hold_for_part/3,      % +Steps, +In, ?Head
            proof/3,                    % +Module, ?Head, -Trace
            attempt/3,                  % +Module, ?Head, -Trace
            closest/3,                  % +Module, +Heads, -Nearest
            nearest/2,                  % +Traces, -Nearest
            certainty/2,                % +Conditions, -Certainty
            with_memory/1,              % :Goal
            failing/2,                  % +Conditions, -Failing
            extreme/3                   % +Measure, +Conditions, -Extreme
          ]).
:- use_module(measurement).
:- use_module(quantities, [quantity_part/2]).
:- use_module(reading).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(option)).
:- use_module(library(pairs)).

:- meta_predicate with_memory(0).

%   further_part(+Module, ?Head): Head, about a part, holds by a learned rule; as
%   holds_for_part/2.

:- multifile further_part/2.
:- dynamic further_part/2.

%!  holds_for_part(+Module, ?Head) is nondet.
%
%   Head holds for a part, its first argument, by a rule of Module, as in proof/3; but
%   nothing is measured, and a rule gives each part once, on whatever other parts.

holds_for_part(Module, Head) :-
    file_rule(Module, Head, Steps, _, _, In),
    steps_hold_for_part(Steps, In, Head).
holds_for_part(Module, Head) :-
    further_part(Module, Head).

%!  steps_hold_for_part(+Steps, +In, ?Head) is nondet.
%
%   The steps of a rule with this head, asked in module In, hold.

steps_hold_for_part(Steps, In, Head) :-
    arg(1, Head, Part),
    (   Steps = [find(Goal)|Rest],
        finds_part(Goal, ID),
        ID == Part
    ->  call(In:Goal),
        once(holding(Rest, In))
    ;   holding(Steps, In)
    ).

holding([], _).
holding([Step|Steps], Module) :-
    step_holds(Step, Module),
    holding(Steps, Module).

holding_rule(Module, Head) :-
    rule(Module, Head, Steps, _, _, In),
    holding(Steps, In).

step_holds(find(Goal), Module) :- call(Module:Goal).
step_holds(enter(Goal), Module) :- solution(Module, Goal).
step_holds(deny(Goal, _, _), Module) :- \+ provable(Module, Goal).
step_holds(test(Goal, _, _), Module) :- call(Module:Goal).

%!  proof(+Module, ?Head, -Trace) is nondet.
%
%   Head, a part and what it is for, holds by a rule of Module; Trace is a dict with
%   the rule, the parts it was proved on and every condition. What was measured is
%   worked out only when the rule has been proved.

proof(Module, Head, Trace) :-
    rule(Module, Head, Steps, Parts, Title, In),
    run(Steps, strictly, In, Tried, []),
    traced(Head, Tried, Parts, Title, Trace).

%!  attempt(+Module, ?Head, -Trace) is nondet.
%
%   A rule of Module about Head on some choice of parts, whether it holds or
%   not.

attempt(Module, Head, Trace) :-
    without_bound(tried_softly(Module, Head, Tried, Parts, Title)),
    traced(Head, Tried, Parts, Title, Trace).

tried_softly(Module, Head, Tried, Parts, Title) :-
    rule(Module, Head, Steps, Parts, Title, In),
    run(Steps, softly, In, Tried, []).

traced(Head, Tried, Parts, Title, Trace) :-
    maplist(condition, Tried, Conditions),
    (   exclude(holds, Conditions, []) -> Holds = true ; Holds = false ),
    subject(Head, Part, Subject),
    atomic_list_concat([Title, :, Subject], Rule),
    include(bound_part, Parts, Bound),
    dict_pairs(Bindings, bindings, Bound),
    certainty(Conditions, Certainty),
    Trace = trace{rule: Rule, part: Part, holds: Holds, bindings: Bindings, conditions: Conditions,
                  certainty: Certainty}.

%!  closest(+Module, +Heads, -Nearest) is semidet.
%
%   The nearest (nearest/2) of all attempts at Heads. An attempt is given up as soon
%   as it is farther off than the nearest one so far.

closest(Module, Heads, Nearest) :-
    Best = best(none, none),
    (   member(Head, Heads),
        b_setval(explain_best, Best),
        b_setval(explain_distance, distance(0, 0, 0.0)),
        tried_softly(Module, Head, Tried, Parts, Title),
        b_getval(explain_distance, Distance),
        arg(1, Best, Least),
        (   Least == none -> true ; Distance @< Least ),
        nb_setarg(1, Best, Distance),
        nb_setarg(2, Best, found(Head, Tried, Parts, Title)),
        fail
    ;   true
    ),
    arg(2, Best, found(Head, Tried, Parts, Title)),
    traced(Head, Tried, Parts, Title, Nearest).

%   Attempts that are not a search for the nearest one know no bound.

without_bound(Goal) :-
    b_setval(explain_best, best(none, none)),
    b_setval(explain_distance, distance(0, 0, 0.0)),
    call(Goal).

farther(Kind, By) :-
    b_getval(explain_distance, distance(Same0, Failing0, Excess0)),
    (   Kind == distinct -> Same is Same0 + 1 ; Same = Same0 ),
    Failing is Failing0 + 1,
    Excess is Excess0 + By,
    Distance = distance(Same, Failing, Excess),
    b_getval(explain_best, Best),
    arg(1, Best, Least),
    (   Least == none -> true ; Distance @=< Least ),
    b_setval(explain_distance, Distance).

%   What a rule is about: affordTask(ID, Task) about Task, handle(ID) about handle.

subject(Head, Part, Subject) :-
    Head =.. [_, Part, Subject],
    atom(Subject),
    !.
subject(Head, Part, Name) :-
    Head =.. [Name|Arguments],
    (   Arguments = [Part|_]
    ->  true
    ;   Part = null
    ).

holds(Condition) :-
    true == Condition.holds.

bound_part(_-ID) :-
    integer(ID).

%   Each step that is a condition gives tried(Step, Module, Holds, Condition);
%   Condition is worked out at once only for one that fails, and is not a mere bound.

run([], _, _, Tried, Tried).
run([Step|Steps], Manner, Module, Tried, Tail) :-
    step(Step, Manner, Module, Tried, Middle),
    run(Steps, Manner, Module, Middle, Tail).

step(find(Goal), _, Module, Tried, Tried) :-
    call(Module:Goal).
step(enter(Goal), Manner, Module, Tried, Tail) :-
    (   Manner == strictly
    ->  provable(Module, Goal)          % cheap, and mostly known
    ;   true
    ),
    rule(Module, Goal, Steps, _, _, In),
    run(Steps, Manner, In, Tried, Tail).
step(deny(Goal, ID, Text), Manner, Module, [Tried|Tail], Tail) :-
    (   provable(Module, Goal)
    ->  Manner == softly,
        Holds = false
    ;   Holds = true
    ),
    settled(tried(deny(Goal, ID, Text), Module, Holds, _), Tried).
step(test(Goal, ID, Text), strictly, Module, [tried(test(Goal, ID, Text), Module, true, _)|T], T) :-
    call(Module:Goal).
step(test(Goal, ID, Text), softly, Module, [Tried|Tail], Tail) :-
    (   catch(Module:Goal, error(instantiation_error, _), fail)
    *-> Holds = true
    ;   Holds = false
    ),
    settled(tried(test(Goal, ID, Text), Module, Holds, _), Tried).

settled(Tried, Tried) :-
    Tried = tried(Step, _, Holds, _),
    (   Holds == true
    ->  true
    ;   Step = test(Goal, _, _),
        bound_excess(Goal, Excess)      % all that is needed of it, unless it is the nearest
    ->  farther(bound, Excess)
    ;   condition(Tried, Condition),
        farther(Condition.kind, Condition.excess)
    ).

condition(tried(Step, Module, Holds, Condition), Condition) :-
    (   nonvar(Condition)
    ->  true
    ;   worked_out(Step, Module, Holds, Condition)
    ).

worked_out(test(Goal, ID, Text), _, Holds, Condition) :-
    measurement(Goal, ID, Measurement),
    (   integer(ID) -> Part = ID ; goal_part(Goal, Part) -> true ; Part = null ),
    Condition = Measurement.put(_{predicate: Text, part: Part, holds: Holds}).
worked_out(deny(Goal, ID, Text), Module, Holds, Condition) :-
    denied(Module, Goal, Holds, Denied),
    denied_part(ID, Goal, Part),
    Condition = Denied.put(_{predicate: Text, part: Part, holds: Holds}).

goal_part(at_least(Quantity, _), ID) :- quantity_part(Quantity, ID).
goal_part(at_most(Quantity, _), ID) :- quantity_part(Quantity, ID).
goal_part(meets(ID, _), ID) :- integer(ID).
goal_part(fits_gripper(ID), ID) :- integer(ID).

%   A negation is as certain as what it denies is not: by the nearest miss if it
%   holds, by the surest proof if it fails. Its margin is that of the condition which
%   decides.

denied(Module, Goal, Holds, Denied) :-
    remember(denied(Module, Goal), Denied, denied_now(Module, Goal, Holds, Denied)).

%   Goal holds by a rule, for these parts; without working out why.

solution(Module, Goal) :-
    solutions(Module, Goal, Solutions),
    member(Goal, Solutions).

provable(Module, Goal) :-
    solutions(Module, Goal, [_|_]).

solutions(Module, Goal, Solutions) :-
    remember(solutions(Module, Goal), Solutions,
             ( findall(Goal, holding_rule(Module, Goal), All), sort(All, Solutions) )).

%!  with_memory(:Goal) is semidet.
%
%   Prove Goal once. What entered rules gave and what was denied on the way is
%   remembered until it ends, for the parts do not change meanwhile: many rules ask
%   the same.

with_memory(Goal) :-
    setup_call_cleanup(
        ( trie_new(Memory), nb_setval(explain_memory, Memory) ),
        once(Goal),
        ( nb_delete(explain_memory), trie_destroy(Memory) )).

%   Questions that differ only in the names of variables are the same.

remember(Question, Answer, Goal) :-
    (   nb_current(explain_memory, Memory)
    ->  (   trie_lookup(Memory, Question, Known)
        ->  Answer = Known
        ;   copy_term(Question, Key),
            once(Goal),
            trie_insert(Memory, Key, Answer)
        )
    ;   once(Goal)
    ).

denied_now(Module, Goal, Holds, Denied) :-
    (   Holds == true
    ->  (   closest(Module, [Goal], Nearest)
        ->  Support is 1 - Nearest.certainty,
            failing(Nearest.conditions, Failing),
            extreme(excess, Failing, Because)
        ;   Support = 1.0, Because = null
        ),
        Excess = 0.0, Sign = 1
    ;   findall(Doubt-Trace,
                ( proof(Module, Goal, Trace), Doubt is 1 - Trace.certainty ),
                Proofs),
        keysort(Proofs, [Support-Surest|_]),
        (   extreme(doubt, Surest.conditions, Because)
        ->  true
        ;   Because = null
        ),
        Excess is 3 * (1 - Support), Sign = -1
    ),
    (   is_dict(Because),
        Found = Because.margin,
        number(Found)
    ->  Margin is Sign * abs(Found), Unit = Because.unit
    ;   Margin = null, Unit = null
    ),
    subject(Goal, _, About),
    Denied = m{kind: absent, measured: About, required: null, margin: Margin, unit: Unit,
               support: Support, excess: Excess, outside: [], because: Because}.

denied_part(ID, _, ID) :- integer(ID), !.
denied_part(_, Goal, ID) :- subject(Goal, ID, _), integer(ID), !.
denied_part(_, _, null).

%!  failing(+Conditions, -Failing) is det.

failing(Conditions, Failing) :-
    exclude(holds, Conditions, Failing).

%!  extreme(+Measure, +Conditions, -Extreme) is semidet.
%
%   The condition with the largest excess, or the largest doubt; the first of
%   equals.

extreme(Measure, Conditions, Extreme) :-
    map_list_to_pairs(negative(Measure), Conditions, Pairs),
    keysort(Pairs, [_-Extreme|_]).

negative(excess, Condition, Key) :-
    Key is -Condition.excess.
negative(doubt, Condition, Support) :-
    Support0 = Condition.support,
    ( number(Support0) -> Support = Support0 ; Support = 1.0 ).

%!  certainty(+Conditions, -Certainty) is det.
%
%   A rule is as certain as its least supported condition.

certainty(Conditions, Certainty) :-
    foldl(less_certain, Conditions, 1.0, Certainty).

less_certain(Condition, Least0, Least) :-
    Support = Condition.support,
    (   number(Support)
    ->  Least is min(Least0, Support)
    ;   Least = Least0
    ).

%!  nearest(+Traces, -Nearest) is semidet.
%
%   The attempt that came closest: different parts where the rule wants different
%   parts, then the fewest failing conditions, then the smallest excess, then the
%   first.

nearest(Traces, Nearest) :-
    map_list_to_pairs(distance, Traces, Pairs),
    keysort(Pairs, [_-Nearest|_]).

distance(Trace, distance(SamePart, Failing, Excess)) :-
    exclude(holds, Trace.conditions, Failed),
    include(about_distinctness, Failed, Same),
    length(Same, SamePart),
    length(Failed, Failing),
    foldl(add_excess, Failed, 0.0, Excess).

about_distinctness(Condition) :-
    distinct == Condition.kind.

add_excess(Condition, Sum0, Sum) :-
    Sum is Sum0 + Condition.excess.
