:- use_module(relations).
:- use_module(library(plunit)).

:- begin_tests(relations, [setup(taught), cleanup(untaught)]).

taught :-
    untaught,
    learn(one, cooking, type, 'Task'),
    learn(one, cooking, requiresAffordance, contain),
    learn(one, cooking, requiresAffordance, grasp),
    learn(one, cooking, hasGraspAffordance, grasp),
    learn(two, handover, type, 'Task'),
    learn(two, handover, avoidsAffordance, wrap_grasp).

untaught :-
    forget(one, _),
    forget(two, _).

all_of(Knowledge, Template, Goal, Found) :-
    with_knowledge(Knowledge, findall(Template, Goal, Found)).

test(each_knowledge_base_is_its_own) :-
    all_of(one, T, task(T), [cooking]),
    all_of(two, T, task(T), [handover]).
test(relations) :-
    all_of(one, A, task_object(A, cooking), [contain, grasp]),
    all_of(one, A, grasp_affordance(A, cooking), [grasp]),
    all_of(two, A, avoided_affordance(A, handover), [wrap_grasp]).
test(outside_of_any_knowledge_nothing_is_known, fail) :-
    triple(_, _, _).
test(learning_twice_is_learning_once) :-
    learn(one, cooking, type, 'Task'),
    all_of(one, x, triple(cooking, type, _), [x]).
test(forgetting_a_subject_leaves_the_others, [cleanup(taught)]) :-
    learn(one, stirring, type, 'Task'),
    forget(one, cooking),
    all_of(one, T, task(T), [stirring]).
test(knowledge_is_put_away_after_an_error, throws(oops)) :-
    catch(with_knowledge(one, throw(oops)), oops, true),
    \+ triple(_, _, _),
    throw(oops).

:- end_tests(relations).
