:- use_module(explain).
:- use_module(reading).
:- use_module(predicates).
:- use_module(library(plunit)).

:- begin_tests(explain, [setup(ready), cleanup(withdraw_parts)]).

ready :-
    use_module(thesis/version1),
    use_module(thesis/version2),
    prepare_rules(thesis_version1, 'thesis/version1'),
    prepare_rules(thesis_version2, 'thesis/version2'),
    odd_rules:use_module(predicates),
    odd_rules:use_module(quantities),
    forall(odd_rule(Rule), assertz(odd_rules:Rule)),
    prepare_rules(odd_rules, odd).

%   Rules as another expert might write them, with what the thesis does not use.

odd_rule(( affordTask(ID, helping) :-
               primitive_values(ID, Dim, _),
               slim(Dim, Limit),
               Limit < 0.1 )).
odd_rule(( affordTask(ID, denying) :-
               primitive_values(ID, Dim, Shape),
               \+ Shape == sphere,
               ( min_ratio(Dim, 3) -> true ; max_ratio(Dim, 1.5) ) )).
odd_rule(( affordTask(ID, refusing) :-
               part(ID),
               \+ slender(ID) )).
odd_rule(( slender(ID) :-
               primitive_values(ID, Dim, _),
               max_dimension(Dim, [0.05, 0.05, 1]) )).
odd_rule(( slim(Dim, 0.2) :- max_dimension(Dim, [0.2, 0.2, 1]) )).
odd_rule(( slim(Dim, 0.05) :- max_dimension(Dim, [0.05, 0.05, 1]) )).

object(Parts) :-
    withdraw_parts,
    forall(nth0(ID, Parts, Dimensions-Shape),
           state_part(ID, [0, 0, 0.7], Dimensions, [0.5, 0.5], Shape, 0.9)).

pan :- object([[0.18, 0.18, 0.06]-cylinder, [0.02, 0.03, 0.2]-cylinder]).
fat_pan :- object([[0.18, 0.18, 0.06]-cylinder, [0.054, 0.03, 0.2]-cylinder]).

failing(Trace, Failing) :-
    findall(P, ( member(C, Trace.conditions), false == C.holds, P = C.predicate ), Failing).

test(a_proof_names_parts_as_the_rule_does,
     [setup(pan), true(Pairs == ['ID'-1, 'ID_tool'-0])]) :-
    proof(thesis_version1, affordTask(1, cooking), Trace),
    dict_pairs(Trace.bindings, _, Pairs),
    !.
test(conditions_stand_as_in_the_rule, [setup(pan), nondet]) :-
    proof(thesis_version1, affordTask(_, cooking), Trace),
    findall(P, ( member(C, Trace.conditions), P = C.predicate ), Predicates),
    assertion(memberchk("max_dimension(Dim, [0.05, 0.05, 1.0])", Predicates)),
    assertion(memberchk("Semantic_shape == cylinder", Predicates)),
    assertion(memberchk("ID \\= ID_tool", Predicates)).
test(every_condition_of_a_proof_holds, [setup(pan), nondet, true(Failing == [])]) :-
    proof(thesis_version1, affordTask(_, cooking), Trace),
    failing(Trace, Failing).
test(no_proof, [setup(fat_pan), fail]) :-
    proof(thesis_version1, affordTask(_, cooking), _).
test(attempts_cover_every_choice_of_parts, [setup(fat_pan), true(Count == 4)]) :-
    aggregate_all(count, attempt(thesis_version1, affordTask(_, cooking), _), Count).
test(attempts_measure_every_condition, [setup(fat_pan), true(Lengths == [7])]) :-
    findall(L, ( attempt(thesis_version1, affordTask(_, cooking), T), length(T.conditions, L) ), Ls),
    sort(Ls, Lengths).
test(nearest_miss, [setup(fat_pan), true(Failing == ["max_dimension(Dim, [0.05, 0.05, 1.0])"])]) :-
    findall(T, attempt(thesis_version1, affordTask(_, cooking), T), Ts),
    nearest(Ts, Nearest),
    failing(Nearest, Failing).
test(nearest_of_none, fail) :-
    nearest([], _).

test(a_helper_predicate_is_entered,
     [setup(pan), nondet, true(P == "max_dimension(_, [0.05, 0.05, 1])")]) :-
    proof(odd_rules, affordTask(1, helping), Trace),
    member(C, Trace.conditions),
    P = C.predicate.
test(helpers_backtrack, [setup(pan), all(ID == [1])]) :-
    proof(odd_rules, affordTask(ID, helping), _).
test(negation_and_choice, [setup(pan), all(ID == [0, 1])]) :-
    proof(odd_rules, affordTask(ID, denying), _).
%   Negation of a goal with rules: as sure as the goal is unsure.

test(denial_holds, [setup(pan), all(ID == [0])]) :-
    proof(odd_rules, affordTask(ID, refusing), _).
test(denial_says_why, [setup(pan), true(Kind-Said-Sure == absent-slender-true)]) :-
    proof(odd_rules, affordTask(0, refusing), Trace),
    Trace.conditions = [C],
    Kind = C.kind, Said = C.measured,
    Because = C.because, Because.kind == max_dimension,
    ( C.support > 0.9 -> Sure = true ; Sure = C.support ),
    !.
test(denial_fails_softly, [setup(pan), true(Holds-Sign == false-negative)]) :-
    attempt(odd_rules, affordTask(1, refusing), Trace),
    Trace.conditions = [C],
    Holds = C.holds,
    ( C.margin < 0 -> Sign = negative ; Sign = C.margin ),
    !.
test(denials_are_remembered_for_one_goal_only, [setup(pan), true(Then-Now == [0]-[1])]) :-
    with_memory(findall(ID, proof(odd_rules, affordTask(ID, refusing), _), Then)),
    object([[0.02, 0.03, 0.2]-cylinder, [0.18, 0.18, 0.06]-cylinder]),
    with_memory(findall(ID, proof(odd_rules, affordTask(ID, refusing), _), Now)).
test(closest_is_the_nearest_of_all_attempts, [setup(set_random(seed(11))), forall(between(1, 60, _))]) :-
    random_object,
    forall(member(Module:Heads, [ thesis_version1:[affordTask(_, _)],
                                  thesis_version1:[affordTask(_, cooking), affordTask(_, pouring)],
                                  thesis_version2:[partAffordance(0, _)],
                                  odd_rules:[affordTask(_, refusing)],
                                  odd_rules:[affordTask(_, helping)] ]),
           ( findall(T, ( member(Head, Heads), attempt(Module, Head, T) ), Attempts),
             nearest(Attempts, Nearest),
             closest(Module, Heads, Closest),
             assertion(Nearest == Closest) )).
test(closest_of_none, fail) :-
    closest(odd_rules, [affordTask(_, unheard_of)], _).
test(memory_changes_nothing, [setup(set_random(seed(9))), forall(between(1, 30, _))]) :-
    random_object,
    findall(ID, proof(odd_rules, affordTask(ID, refusing), _), Plain),
    with_memory(( findall(ID, proof(odd_rules, affordTask(ID, refusing), _), First),
                  findall(ID, proof(odd_rules, affordTask(ID, refusing), _), Second) )),
    assertion(Plain == First),
    assertion(Plain == Second).

test(a_condition_without_scale_is_tried_softly, [setup(object([[0.1, 0.1, 0.1]-sphere])), nondet]) :-
    attempt(odd_rules, affordTask(0, denying), Trace),
    failing(Trace, Failing),
    assertion(Failing == ["\\+_==sphere"]).

%   The interpreter proves exactly what Prolog itself proves, and an attempt holds
%   exactly when it is a proof.

test(as_prolog_does, [setup(set_random(seed(7))), forall(between(1, 60, _))]) :-
    random_object,
    forall(member(Module:Head, [ thesis_version1:affordTask(_, _),
                                 thesis_version2:partAffordance(_, _) ]),
           ( answers(Head, Module:Head, Plain),
             answers(Head, proof(Module, Head, _), Proved),
             answers(Head, ( attempt(Module, Head, T), get_dict(holds, T, true) ), Attempted),
             assertion(Plain == Proved),
             assertion(Plain == Attempted) )).

answers(Head, Goal, Answers) :-
    findall(Head, Goal, All),
    sort(All, Answers).

random_object :-
    random_between(1, 4, Count),
    findall(Dimensions-Shape,
            ( between(1, Count, _), random_dimensions(Dimensions),
              random_member(Shape, [cuboid, cylinder, sphere]) ),
            Parts),
    object(Parts).

random_dimensions([A, B, C]) :-
    maplist(random_length, [A, B, C]).

random_length(Length) :-
    random(Random),
    Length is 0.002 * 150 ** Random.

%   The margin of a condition says whether it holds.

test(margins_agree, [setup(set_random(seed(8))), forall(between(1, 40, _))]) :-
    random_object,
    forall(( attempt(thesis_version1, affordTask(_, _), T), member(C, T.conditions),
             get_dict(margin, C, Margin), number(Margin) ),
           assertion(( Margin >= 0 -> true == C.holds ; false == C.holds ))).

:- end_tests(explain).
