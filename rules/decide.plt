:- use_module(decide).
:- use_module(predicates).
:- use_module(relations).
:- use_module(rule_sets).
:- use_module(sketch).
:- use_module(library(plunit)).

:- begin_tests(decide, [setup(ready), cleanup(( withdraw_parts, forget(test, _) ))]).

ready :-
    module_property(rule_sets, file(File)),
    file_directory_name(File, Directory),
    load_rule_set(Directory, thesis),
    load_rule_set(Directory, default),
    forget(test, _),
    task_with(cooking, [contain, grasp], [grasp], []),
    task_with(pouring, [contain], [grasp, wrap_grasp], []),
    task_with(handover, [], [], [wrap_grasp]),
    task_with(cutting, [cut, grasp], [grasp], [cut]).

task_with(Task, Requires, Grasps, Avoids) :-
    learn(test, Task, type, 'Task'),
    forall(member(A, Requires), learn(test, Task, requiresAffordance, A)),
    forall(member(A, Grasps), learn(test, Task, hasGraspAffordance, A)),
    forall(member(A, Avoids), learn(test, Task, avoidsAffordance, A)).

object(Parts) :-
    withdraw_parts,
    forall(nth0(ID, Parts, Dimensions-Shape),
           state_part(ID, [0, 0, 0.7], Dimensions, [0.5, 0.5], Shape, 0.9)).

pan :- object([[0.18, 0.18, 0.06]-cylinder, [0.02, 0.03, 0.2]-cylinder]).
bottle :- object([[0.07, 0.07, 0.2]-cylinder]).
knife :- object([[0.002, 0.03, 0.18]-cuboid, [0.015, 0.025, 0.11]-cuboid]).

decided(Version, Task, Decision) :-
    with_knowledge(test, decision(thesis, Version, Task, Decision)).

outcome(Version, Task, Outcome) :-
    decided(Version, Task, Decision),
    Outcome = Decision.outcome.

parts_of(Decision, Parts) :-
    findall(P, ( member(R, Decision.regions), P = R.parts ), Parts).

test(version_1, [setup(pan), true(Parts == [[1]])]) :-
    decided(v1, cooking, D), parts_of(D, Parts).
test(version_2, [setup(pan), true(Parts == [[1]])]) :-
    decided(v2, cooking, D), parts_of(D, Parts).
test(unknown_task, [setup(pan), true(Outcome == unknown_task)]) :-
    outcome(v2, dancing, Outcome).
test(no_parts, [setup(object([])), true(Outcome == no_primitives)]) :-
    outcome(v2, cooking, Outcome).
test(version_1_miss, [setup(bottle), true(Outcome == no_part_matches)]) :-
    outcome(v1, cooking, Outcome).
test(lacking_affordance, [setup(bottle), true(Said == [object_lacks_affordance, [grasp], 'thesis/version2:grasp'])]) :-
    decided(v2, cooking, D),
    Said = [D.outcome, D.lacking, D.miss.rule].
test(any_grasp_affordance_will_do, [setup(bottle), true(Parts == [[0]])]) :-
    decided(v2, pouring, D), parts_of(D, Parts).
test(avoiding_takes_all_other_parts, [setup(three_parts), true(Parts == [[1, 2]])]) :-
    decided(v2, handover, D), parts_of(D, Parts).

three_parts :-
    object([[0.07, 0.07, 0.2]-cylinder, [0.02, 0.03, 0.2]-cylinder, [0.03, 0.03, 0.03]-sphere]).

test(every_part_avoided, [setup(bottle), true(Outcome == every_part_avoided)]) :-
    outcome(v2, handover, Outcome).
test(a_blade_is_not_held, [setup(knife), true(Parts == [[1]])]) :-
    decided(v2, cutting, D), parts_of(D, Parts).
test(labels, [setup(knife), true(Labels == ['cut grasp', 'grasp pound'])]) :-
    decided(v2, cutting, D),
    findall(As, ( member(L, D.labels), As = L.affordances ), Labels).
test(the_most_certain_comes_first, [setup(two_handles), true(Parts == [[2], [1]])]) :-
    decided(v2, cooking, D), parts_of(D, Parts).

two_handles :-
    object([[0.18, 0.18, 0.06]-cylinder, [0.02, 0.049, 0.2]-cylinder, [0.02, 0.03, 0.2]-cylinder]).

%   The rule set `default` joins the parts that may be held.

default(Version, Task, Decision) :-
    with_knowledge(test, decision(default, Version, Task, Decision)).

pan_with_a_handle_in_two_pieces :-
    sketch([ box([0, 0, 0.03], [0.24, 0.24, 0.06], []), box([0.16, 0, 0.05], [0.08, 0.03, 0.02], []),
             box([0.24, 0, 0.05], [0.08, 0.028, 0.02], []) ]).

test(pieces_together, [setup(pan_with_a_handle_in_two_pieces), cleanup(wipe),
                       forall(member(Version, [v1, v2])), true(First == [1, 2])]) :-
    default(Version, cooking, D),
    parts_of(D, [First|Singles]),
    msort(Singles, [[1], [2]]).
%   The inner half of a haft is none by itself; it goes with the outer half.

knife_with_a_haft_in_two_pieces :-
    sketch([ box([0, 0, 0.01], [0.19, 0.04, 0.004], [shape(cuboid)]),
             box([0.125, 0, 0.01], [0.06, 0.026, 0.018], []),
             box([0.185, 0, 0.01], [0.06, 0.026, 0.018], []) ]).

test(what_goes_with_a_part_is_held_with_it,
     [setup(knife_with_a_haft_in_two_pieces), cleanup(wipe),
      forall(member(Version, [v1, v2])), true(Parts == [[1, 2], [2]])]) :-
    default(Version, cutting, D), parts_of(D, Parts).
test(and_handed_over_with_it,
     [setup(knife_with_a_haft_in_two_pieces), cleanup(wipe),
      forall(member(Version, [v1, v2])), true(First == [0])]) :-
    default(Version, handover, D), parts_of(D, [First|_]).
test(together_is_as_sure_as_the_least_sure,
     [setup(pan_with_a_handle_in_two_pieces), cleanup(wipe), true(Whole =:= Least)]) :-
    default(v1, cooking, D),
    findall(C, ( member(R, D.regions), C = R.confidence ), [Whole|Singles]),
    min_list(Singles, Least).
test(the_thesis_holds_one_of_them,
     [setup(three_parts_of_a_pan), true(Parts == [[1], [2]])]) :-
    decided(v1, cooking, D), parts_of(D, Parts0), msort(Parts0, Parts).

three_parts_of_a_pan :-
    object([ [0.24, 0.24, 0.06]-cylinder, [0.08, 0.03, 0.02]-cylinder, [0.08, 0.028, 0.02]-cylinder ]).

can :- sketch([box([0, 0, 0.055], [0.066, 0.066, 0.11], [])]).

test(held_if_alone, [setup(can), cleanup(wipe), true(Parts == [[0]])]) :-
    default(v2, handover, D), parts_of(D, Parts).
test(alone_is_said, [setup(can), cleanup(wipe), true(Kinds == [alone])]) :-
    default(v2, handover, D),
    D.traces = [Relation|_],
    findall(K, ( member(C, Relation.conditions), K = C.kind ), Kinds).
test(not_alone, [setup(bottle_with_a_cap), cleanup(wipe), true(Parts == [[1]])]) :-
    default(v2, handover, D), parts_of(D, Parts).

bottle_with_a_cap :-
    sketch([ box([0, 0, 0.035], [0.16, 0.07, 0.07], []), box([0.1, 0, 0.035], [0.04, 0.03, 0.03], []) ]).

:- end_tests(decide).
