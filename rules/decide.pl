/*  Which part to hold for a task: reasoning Version 1 and Version 2 of
    chapter 5.2.

    Both give a decision: a dict with

        outcome        found, or why not (the codes of docs/reasons.md)
        regions        the parts to hold, best first, each with affordance and
                       confidence
        labels         Version 2: the affordances of each part
        traces         the rules that hold and led to the first region
        miss           the nearest miss when nothing was found, else null
        lacking        when that is why, the affordances that no part has
        too_thick      parts of the first region that do not go between the fingers

    A region is as certain as the least supported condition of what led to it
    (measurement.pl says what support is). Of several, the most certain is the
    answer and the others are alternatives; equals keep the order of the parts.
*/

:- module(decide, [decision/4]).                % +RuleSet, +Version, +Task, -Decision
:- use_module(explain).
:- use_module(reading, [has_rule/2]).
:- use_module(predicates, [primitive_values/3]).
:- use_module(quantities, [fits_gripper/1, quantity/3]).
:- use_module(relations).
:- use_module(rule_sets, [held_if_alone/3, held_together/3, rule_module/3]).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(pairs)).

%!  decision(+RuleSet, +Version, +Task, -Decision) is det.
%
%   Version is v1 or v2.

decision(RuleSet, Version, Task, Decision) :-
    by_version(RuleSet, Version, Task, Found),
    too_thick(Found, Parts),
    Decision = Found.put(too_thick, Parts).

by_version(RuleSet, v1, Task, Decision) :-
    (   rule_module(RuleSet, v1, Module),
        has_rule(Module, affordTask(_, Task))
    ->  task_decision(RuleSet, Task, Decision)
    ;   Decision = decision{outcome: unknown_task}
    ).
by_version(RuleSet, v2, Task, Decision) :-
    (   task(Task)
    ->  affordance_decision(RuleSet, Task, Decision)
    ;   Decision = decision{outcome: unknown_task}
    ).

%   Parts of the answer that do not go between the fingers: no rule here refuses them, for
%   the grasp may yet find a side that does, but it is told.

too_thick(Decision, Parts) :-
    (   get_dict(regions, Decision, [Region|_]),
        quantity(gripper_opening, Opening, m)
    ->  findall(thick{part: ID, thickness: Thickness, opening: Opening},
                ( member(ID, Region.parts),
                  \+ fits_gripper(ID),
                  quantity(thickness(ID), Thickness, m) ),
                Parts)
    ;   Parts = []
    ).

nothing(Outcome, Decision) :-
    Decision = decision{outcome: Outcome, regions: [], labels: [], traces: [], miss: null,
                        lacking: []}.

                /*******************************
                *          VERSION 1           *
                *******************************/

task_decision(_, _, Decision) :-
    \+ primitive_values(_, _, _),
    !,
    nothing(no_primitives, Decision).
task_decision(RuleSet, Task, Decision) :-
    rule_module(RuleSet, v1, Module),
    findall(ID-Trace, proof(Module, affordTask(ID, Task), Trace), Proofs),
    (   Proofs == []
    ->  closest_or_null(Module, [affordTask(_, Task)], Miss),
        nothing(no_part_matches, Nothing),
        Decision = Nothing.put(miss, Miss)
    ;   most_certain_each(Proofs, Best),
        ranked(Best, [ID1-Trace1|Others]),
        maplist(region_of_proof, [ID1-Trace1|Others], Singles),
        pairs_keys([ID1-Trace1|Others], IDs),
        findall(Tool, acting(Best, IDs, Tool), Tools),
        companions(Module, IDs, Tools, Companions),
        append(Others, Companions, More),
        (   More = [_|_],
            held_together(RuleSet, v1, Task)
        ->  maplist(region_of_proof, [ID1-Trace1|More], All),
            together(All, Together),
            Regions = [Together|Singles],
            pairs_values([ID1-Trace1|More], Traces)
        ;   Regions = Singles,
            Traces = [Trace1]
        ),
        nothing(found, Nothing),
        Decision = Nothing.put(_{regions: Regions, traces: Traces})
    ).

region_of_proof(ID-Trace, region{parts: [ID], affordance: null, confidence: Certainty}) :-
    Certainty = Trace.certainty.

%   A part that a proof puts in another role.

acting(Proofs, IDs, Tool) :-
    member(_-Trace, Proofs),
    dict_pairs(Trace.bindings, _, Pairs),
    member(_-Tool, Pairs),
    \+ memberchk(Tool, IDs).

%   Parts that go with those in IDs and are not among Excluded: ID-Trace, the most
%   certain trace for each.

companions(Module, IDs, Excluded, Companions) :-
    findall(ID-Trace,
            ( member(Other, IDs),
              proof(Module, goes_with(ID, Other), Trace),
              \+ memberchk(ID, IDs),
              \+ memberchk(ID, Excluded) ),
            Proofs),
    most_certain_each(Proofs, Companions).

%   All parts as one region, as certain as the least certain of them.

together(Singles, region{parts: Parts, affordance: Affordance, confidence: Confidence}) :-
    Singles = [First|_],
    Affordance = First.affordance,
    findall(ID, ( member(Single, Singles), member(ID, Single.parts) ), IDs),
    sort(IDs, Parts),
    findall(C, ( member(Single, Singles), C = Single.confidence ), Confidences),
    min_list(Confidences, Confidence).

%   The most certain trace for each key; of equals the first.

most_certain_each(Proofs, Best) :-
    keysort(Proofs, Sorted),
    group_pairs_by_key(Sorted, Groups),
    maplist(most_certain_of, Groups, Best).

most_certain_of(Key-Traces, Key-Best) :-
    ranked_traces(Traces, [Best|_]).

ranked_traces(Traces, Ranked) :-
    map_list_to_pairs(uncertainty, Traces, Pairs),
    keysort(Pairs, Sorted),
    pairs_values(Sorted, Ranked).

ranked(Pairs, Ranked) :-
    map_list_to_pairs(pair_uncertainty, Pairs, Keyed),
    keysort(Keyed, Sorted),
    pairs_values(Sorted, Ranked).

pair_uncertainty(ID-Trace, Uncertainty-Grip) :-
    uncertainty(Trace, Uncertainty),
    grip_rank(ID, Grip).

%   Of equals, what goes between the fingers comes first.

grip_rank(ID, Rank) :-
    (   fits_gripper(ID)
    ->  Rank = 0
    ;   Rank = 1
    ).

uncertainty(Trace, Uncertainty) :-
    Uncertainty is 1 - Trace.certainty.

closest_or_null(Module, Heads, Miss) :-
    (   closest(Module, Heads, Closest)
    ->  Miss = Closest
    ;   Miss = null
    ).

                /*******************************
                *          VERSION 2           *
                *******************************/

affordance_decision(_, _, Decision) :-
    \+ primitive_values(_, _, _),
    !,
    nothing(no_primitives, Decision).
affordance_decision(RuleSet, Task, Decision) :-
    rule_module(RuleSet, v2, Module),
    findall(A, ( task_object(A, Task) ; grasp_affordance(A, Task) ; avoided_affordance(A, Task) ),
            Asked0),
    sort(Asked0, Asked),
    labelled(Module, Asked, Labelled),
    labels(Module, Asked, Labelled, Labels),
    findall(A, task_object(A, Task), Required0),
    sort(Required0, Required),
    exclude(offered(Labelled), Required, Lacking),
    (   Lacking = [_|_]
    ->  closest_to_label(Module, Lacking, Miss),
        nothing(object_lacks_affordance, Nothing),
        Chosen = Nothing.put(_{lacking: Lacking, miss: Miss})
    ;   maplist(best_of(Labelled), Required, Provided),
        choose(RuleSet, Module, Task, Labelled, Provided, Chosen)
    ),
    Decision = Chosen.put(labels, Labels).

%   Every part with the affordances that the task speaks of and the part has, proved:
%   (Affordance-ID)-Trace.

labelled(Module, Asked, Labelled) :-
    findall((Affordance-ID)-Trace,
            ( member(Affordance, Asked), proof(Module, partAffordance(ID, Affordance), Trace) ),
            Proofs),
    most_certain_each(Proofs, Labelled).

%   Every part with all its affordances. Those that the task does not speak of need no
%   proof that can be shown.

labels(Module, Asked, Labelled, Labels) :-
    findall(ID-Affordance, member((Affordance-ID)-_, Labelled), Shown),
    findall(ID-Affordance,
            ( holds_for_part(Module, partAffordance(ID, Affordance)),
              \+ memberchk(Affordance, Asked) ),
            Others),
    findall(ID-none, primitive_values(ID, _, _), Parts),
    append([Parts, Shown, Others], All),
    keysort(All, Sorted),
    group_pairs_by_key(Sorted, Grouped),
    maplist(label, Grouped, Labels).

%   The names of the affordances in one text, apart by spaces: there may be hundreds.

label(ID-[none|Affordances], label{part: ID, affordances: Names}) :-
    sort(Affordances, Ordered),
    atomic_list_concat(Ordered, ' ', Names).

offered(Labelled, Affordance) :-
    memberchk((Affordance-_)-_, Labelled).

best_of(Labelled, Affordance, provided(Affordance, ID, Trace)) :-
    findall(Part-T, member((Affordance-Part)-T, Labelled), Parts),
    ranked(Parts, [ID-Trace|_]).

closest_to_label(Module, Affordances, Miss) :-
    findall(partAffordance(_, Affordance), member(Affordance, Affordances), Heads),
    closest_or_null(Module, Heads, Miss).

%   What may be held: a part with a grasp affordance, or any part if the task names
%   none; and no part with an affordance to avoid.

choose(RuleSet, Module, Task, Labelled, Provided, Decision) :-
    findall(A, grasp_affordance(A, Task), Graspable0),
    findall(A, avoided_affordance(A, Task), Avoided0),
    sort(Graspable0, Graspable),
    sort(Avoided0, Avoided),
    findall(Grip, grip(Graspable, Labelled, Grip), Grips),
    partition(occupied(Labelled, Avoided), Grips, Occupied, Free),
    (   Free = [_|_]
    ->  found(RuleSet, Module, Task, Graspable, Avoided, Provided, Free, Decision)
    ;   Occupied = [_|_],
        held_if_alone(RuleSet, v2, Task)
    ->  found_alone(RuleSet, Module, Task, Graspable, Avoided, Provided, Occupied, Decision)
    ;   Occupied = [_|_]
    ->  nothing(every_part_avoided, Nothing),
        least_avoided(Task, Labelled, Avoided, Occupied, Miss),
        Decision = Nothing.put(miss, Miss)
    ;   nothing(no_grasp_part, Nothing),
        closest_to_label(Module, Graspable, Miss),
        Decision = Nothing.put(_{lacking: Graspable, miss: Miss})
    ).

%   grip(ID, Affordance, Traces): hold part ID by Affordance, which Traces prove.

grip([], _, grip(ID, null, [])) :-
    !,
    primitive_values(ID, _, _).
grip(Graspable, Labelled, grip(ID, Affordance, [Trace])) :-
    member((Affordance-ID)-Trace, Labelled),
    memberchk(Affordance, Graspable).

occupied(Labelled, Avoided, grip(ID, _, _)) :-
    member(Affordance, Avoided),
    memberchk((Affordance-ID)-_, Labelled),
    !.

%   Without a grasp affordance all the parts together are the region; otherwise
%   each is one of its own.

found(_, Module, Task, [], Avoided, Provided, Grips, Decision) :-
    !,
    findall(ID, member(grip(ID, _, _), Grips), IDs),
    option(Module, Task, Avoided, Provided, IDs, null, [], Region, Relation),
    decided(Provided, [], [Region], Relation, Decision).
found(RuleSet, Module, Task, _, Avoided, Provided, Grips, Decision) :-
    findall(Region-option(Relation, Traces),
            ( member(grip(ID, Affordance, Traces), Grips),
              option(Module, Task, Avoided, Provided, [ID], Affordance, Traces, Region, Relation) ),
            Options),
    best_regions(Options, Best),
    findall(ID, ( member(Single-_, Best), member(ID, Single.parts) ), IDs),
    findall(ID, not_a_companion(Module, Avoided, Provided, IDs, ID), Excluded),
    companions(Module, IDs, Excluded, Companions),
    append(Best, Companions, Held),
    (   Held = [_, _|_],
        held_together(RuleSet, v2, Task)
    ->  all_together(Module, Task, Avoided, Provided, Best, Companions,
                     [Region-option(Relation, Traces)|Others])
    ;   Best = [Region-option(Relation, Traces)|Others]
    ),
    pairs_keys(Others, Alternatives),
    decided(Provided, Traces, [Region|Alternatives], Relation, Decision).

%   What the task needs elsewhere or avoids is not held for the sake of a companion.

not_a_companion(_, _, Provided, IDs, ID) :-
    member(provided(_, ID, _), Provided),
    \+ memberchk(ID, IDs).
not_a_companion(Module, Avoided, _, _, ID) :-
    member(Affordance, Avoided),
    proof(Module, partAffordance(ID, Affordance), _).

all_together(Module, Task, Avoided, Provided, Best, Companions,
             [Region-option(Relation, Traces)|Best]) :-
    findall(ID, ( member(Single-_, Best), member(ID, Single.parts) ), Own),
    pairs_keys(Companions, Further),
    append(Own, Further, IDs0),
    sort(IDs0, IDs),
    findall(Trace, ( member(_-option(_, Each), Best), member(Trace, Each) ), OwnTraces),
    pairs_values(Companions, FurtherTraces),
    append(OwnTraces, FurtherTraces, Traces),
    Best = [First-_|_],
    option(Module, Task, Avoided, Provided, IDs, First.affordance, Traces, Region, Relation).

%   Nothing but parts that the task would rather leave free: they are held, and a
%   condition says so.

found_alone(RuleSet, Module, Task, Graspable, Avoided, Provided, Grips, Decision) :-
    found(RuleSet, Module, Task, Graspable, [], Provided, Grips, Found),
    Found.traces = [Relation|Labels],
    findall(ID, member(grip(ID, _, _), Grips), IDs),
    findall(Condition,
            ( member(A, Avoided),
              format(string(Text), "held_if_alone(~q)", [Task]),
              Condition = m{predicate: Text, part: null, holds: true, kind: alone, measured: IDs,
                            required: [A], margin: null, unit: null, support: null, excess: 0.0,
                            outside: []} ),
            Conditions),
    append(Relation.conditions, Conditions, All),
    Decision = Found.put(traces, [Relation.put(conditions, All)|Labels]).

decided(Provided, GraspTraces, Regions, Relation, Decision) :-
    findall(Trace, member(provided(_, _, Trace), Provided), ProvidedTraces),
    append(ProvidedTraces, GraspTraces, All),
    list_to_set(All, Labels),
    nothing(found, Nothing),
    Decision = Nothing.put(_{regions: Regions, traces: [Relation|Labels]}).

%   One way to hold the object: the region, and the relations of the ontology that
%   lead to it as a rule of its own.

option(Module, Task, Avoided, Provided, IDs, Affordance, Traces, Region, Relation) :-
    findall(Condition,
            ( member(provided(Required, ID, _), Provided),
              relation_condition(requiresAffordance, Task, Required, ID, Condition) ),
            Requires),
    findall(Condition,
            ( Affordance \== null, member(ID, IDs),
              relation_condition(hasGraspAffordance, Task, Affordance, ID, Condition) ),
            Grasps),
    findall(Condition,
            ( member(ID, IDs), member(A, Avoided), left_free(Module, Task, A, ID, Condition) ),
            Frees),
    append([Requires, Grasps, Frees], Conditions),
    findall(Trace, member(provided(_, _, Trace), Provided), ProvidedTraces),
    append(ProvidedTraces, Traces, All),
    certainty(Conditions, Certainty0),
    foldl(less_certain, All, Certainty0, Certainty),
    foldl(bind_provided, Provided, bindings{}, Bindings0),
    (   IDs = [ID] -> Bindings = Bindings0.put(region, ID) ; Bindings = Bindings0 ),
    atomic_list_concat([relations, :, Task], Rule),
    Region = region{parts: IDs, affordance: Affordance, confidence: Certainty},
    Relation = trace{rule: Rule, part: null, holds: true, bindings: Bindings,
                     conditions: Conditions, certainty: Certainty}.

less_certain(Trace, Least0, Least) :-
    Least is min(Least0, Trace.certainty).

bind_provided(provided(Affordance, ID, _), Bindings0, Bindings) :-
    Bindings = Bindings0.put(Affordance, ID).

%   The most certain first; of a part that can be held in several ways, the most
%   certain one. Parts that the confidence cannot tell apart, because a required
%   affordance is less certain than either, are told apart by their own label.

best_regions(Options, Best) :-
    map_list_to_pairs(option_uncertainty, Options, Keyed),
    keysort(Keyed, Sorted),
    pairs_values(Sorted, Ranked),
    first_of_each_part(Ranked, [], Best).

option_uncertainty(Region-option(_, [Trace]), Whole-(Own-Grip)) :-
    Whole is 1 - Region.confidence,
    Own is 1 - Trace.certainty,
    [ID] = Region.parts,
    grip_rank(ID, Grip).

first_of_each_part([], _, []).
first_of_each_part([Option|Rest], Seen, Best) :-
    Option = Region-_,
    Region.parts = [ID],
    (   memberchk(ID, Seen)
    ->  Best = Others
    ;   Best = [Option|Others]
    ),
    first_of_each_part(Rest, [ID|Seen], Others).

relation_condition(Property, Task, Affordance, ID, Condition) :-
    format(string(Text), "triple(~q, ~q, ~q)", [Task, Property, Affordance]),
    Condition = m{predicate: Text, part: ID, holds: true, kind: relation, measured: Affordance,
                  required: [Affordance], margin: null, unit: null, support: null, excess: 0.0,
                  outside: []}.

                /*******************************
                *        PARTS TO AVOID        *
                *******************************/

%   A part that lacks Affordance: what failed most clearly says by how much.

left_free(Module, Task, Affordance, ID, Condition) :-
    (   closest(Module, [partAffordance(ID, Affordance)], Nearest)
    ->  Freedom is 1 - Nearest.certainty,
        failing(Nearest.conditions, Failing),
        extreme(excess, Failing, Because),
        Margin = Because.margin,
        ( number(Margin) -> Distance is abs(Margin) ; Distance = null )
    ;   Freedom = 1.0, Because = null, Distance = null
    ),
    avoid_condition(Task, Affordance, ID, true, Freedom, Distance, Because, Condition).

%   Every part is to be left free: the one with the least certain label comes
%   closest, and its tightest condition says by how much.

least_avoided(Task, Labelled, Avoided, Occupied, Miss) :-
    findall(Certainty-label(ID, Affordance, Trace),
            ( member((Affordance-ID)-Trace, Labelled),
              memberchk(grip(ID, _, _), Occupied), memberchk(Affordance, Avoided),
              Certainty = Trace.certainty ),
            Pairs),
    keysort(Pairs, [Least-label(ID, Affordance, Trace)|_]),
    extreme(doubt, Trace.conditions, Because),
    Margin = Because.margin,
    ( number(Margin) -> Distance is -abs(Margin) ; Distance = null ),
    Freedom is 1 - Least,
    avoid_condition(Task, Affordance, ID, false, Freedom, Distance, Because, Condition),
    atomic_list_concat([relations, :, Task], Rule),
    Miss = trace{rule: Rule, part: ID, holds: false, bindings: bindings{region: ID},
                 conditions: [Condition], certainty: Freedom}.

avoid_condition(Task, Affordance, ID, Holds, Support, Distance, Because, Condition) :-
    format(string(Text), "triple(~q, avoidsAffordance, ~q)", [Task, Affordance]),
    (   is_dict(Because) -> Unit = Because.unit ; Unit = null ),
    Condition = m{predicate: Text, part: ID, holds: Holds, kind: avoided, measured: Affordance,
                  required: [Affordance], margin: Distance, unit: Unit, support: Support,
                  excess: 0.0, outside: [], because: Because}.
