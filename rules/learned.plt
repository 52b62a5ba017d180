:- use_module(explain).
:- use_module(reading).
:- use_module(learned).
:- use_module(predicates).
:- use_module(relations).
:- use_module(rule_sets).
:- use_module(library(plunit)).

:- begin_tests(learned, [setup(ready), cleanup(( withdraw_parts, unteach_rule(test, _) ))]).

ready :-
    module_property(rule_sets, file(File)),
    file_directory_name(File, Directory),
    load_rule_set(Directory, thesis).

rule(slicing, _{name: by_handle, head: affordTask, subject: slicing, part: handle, conditions: [
    _{condition: min_dimension, of: [handle], value: [0.005, 0.01, 0.05]},
    _{condition: shape, of: [handle], value: [cylinder, cuboid]},
    _{condition: min_ratio, of: [blade], value: 12},
    _{condition: different, of: [handle, blade], value: null}]}).
rule(sawing, _{name: by_blade, head: affordTask, subject: sawing, part: handle, conditions: [
    _{condition: smallest, of: [blade], value: null},
    _{condition: affords, of: [blade], value: cut},
    _{condition: affords_not, of: [handle], value: cut}]}).
rule(pierce, _{name: sharp, head: partAffordance, subject: pierce, part: part, conditions: [
    _{condition: min_ratio, of: [part], value: 5}]}).

taught(Subject) :-
    unteach_rule(test, _),
    rule(Subject, Rule),
    teach_rule(test, Rule).

knife :- object([[0.002, 0.03, 0.18]-cuboid, [0.015, 0.025, 0.11]-cuboid]).

object(Parts) :-
    withdraw_parts,
    forall(nth0(ID, Parts, Dimensions-Shape),
           state_part(ID, [0, 0, 0.7], Dimensions, [0.5, 0.5], Shape, 0.9)).

proved(Module, Head, Trace) :-
    with_knowledge(test, findall(T, proof(Module, Head, T), Traces)),
    Traces = [Trace|_].

test(held_by_the_handle, [setup(( taught(slicing), knife )), true(ID-Rule == 1-'learned/by_handle/version1:slicing')]) :-
    proved(thesis_version1, affordTask(ID, slicing), Trace),
    ID = Trace.part, Rule = Trace.rule.
test(bindings_are_the_names_of_the_parts, [setup(( taught(slicing), knife )), true(Pairs == [blade-0, handle-1])]) :-
    proved(thesis_version1, affordTask(_, slicing), Trace),
    dict_pairs(Trace.bindings, _, Pairs).
test(nearest_miss, [setup(( taught(slicing), object([[0.015, 0.025, 0.11]-cuboid, [0.015, 0.025, 0.11]-sphere]) )),
                    true(Failing == ["min_ratio(Dim_blade, 12)"])]) :-
    with_knowledge(test, findall(T, attempt(thesis_version1, affordTask(_, slicing), T), Traces)),
    nearest(Traces, Nearest),
    findall(Text, ( member(C, Nearest.conditions), false == C.holds, Text = C.predicate ), Failing).
test(asks_the_rules_of_the_rule_set, [setup(( taught(sawing), knife )), true(ID == 1)]) :-
    proved(thesis_version1, affordTask(ID, sawing), Trace),
    ID = Trace.part.
test(the_proof_holds_the_conditions_of_the_rule_that_was_asked, [setup(( taught(sawing), knife )), nondet]) :-
    proved(thesis_version1, affordTask(_, sawing), Trace),
    member(Condition, Trace.conditions),
    Condition.predicate == "Semantic_shape == cuboid".
test(an_affordance, [setup(( taught(pierce), knife )), all(ID == [0, 1])]) :-
    with_knowledge(test, findall(I, proof(thesis_version2, partAffordance(I, pierce), _), IDs)),
    member(ID, IDs).
%   Without measuring, the same parts, each once however many other parts there are.

test(trying_agrees_with_proving, [setup(( taught(pierce), knife )), true(Tried == Proved)]) :-
    with_knowledge(test, ( findall(I-A, holds_for_part(thesis_version2, partAffordance(I, A)), All),
                           findall(I-A, proof(thesis_version2, partAffordance(I, A), _), Shown) )),
    sort(All, Tried),
    sort(Shown, Proved).
test(a_part_counts_once, [setup(( taught(slicing), blades )), true(Parts == [2])]) :-
    with_knowledge(test, ( findall(I, holds_for_part(thesis_version1, affordTask(I, slicing)), Parts),
                           findall(T, proof(thesis_version1, affordTask(_, slicing), T), Traces) )),
    length(Traces, 2).

blades :-
    object([[0.002, 0.03, 0.18]-cuboid, [0.002, 0.03, 0.18]-cuboid, [0.015, 0.025, 0.11]-cuboid]).

test(is_a_rule, [setup(taught(slicing))]) :-
    with_knowledge(test, has_rule(thesis_version1, affordTask(_, slicing))).
test(of_one_knowledge_base, [setup(taught(slicing)), fail]) :-
    with_knowledge(other, has_rule(thesis_version1, affordTask(_, slicing))).
test(not_without_a_knowledge_base, [setup(taught(slicing)), fail]) :-
    has_rule(thesis_version1, affordTask(_, slicing)).
test(forgotten, [setup(( taught(slicing), unteach_rule(test, by_handle) )), fail]) :-
    with_knowledge(test, has_rule(thesis_version1, affordTask(_, slicing))).
test(unknown_word, error(existence_error(word, halt/1))) :-
    teach_rule(test, _{name: bad, head: affordTask, subject: x, part: part,
                       conditions: [_{condition: halt, of: [part], value: null}]}).

%   What is shown is what an expert would have written: Prolog reads it as a clause.

test(clause, [setup(taught(sawing)), nondet, true(Clause =@= Expected)]) :-
    learned_clause(test, by_blade, Text),
    term_to_atom(Clause, Text),
    term_to_atom(Expected, 'affordTask(H, sawing) :-
        primitive_values(H, _, _, _, _), primitive_values(B, _, _, _, _),
        min_shape(B), partAffordance(B, cut), \\+ partAffordance(H, cut)').

:- end_tests(learned).
