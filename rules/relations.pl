/*  What the ontology says about tasks, as Prolog sees it.

    The ontology (ontology/, OWL in Turtle) is read by the service and handed
    over as triples of local names, e.g. triple(pouring, requiresAffordance,
    contain). They stay between requests and change only when a task is added
    or deleted.

    The relations are those of Code A.3 and of the last clause of Code A.2. The
    thesis models a task as an OWL class with restrictions, hence its
    subclass_of and disjoint_with goals; here a task is an individual and
    carries the properties itself, so one triple goal says the same.

    Several knowledge bases may live in one process; with_knowledge/2 says which
    one is asked.
*/

:- module(relations,
          [ triple/3,                   % ?Subject, ?Property, ?Object
            task/1,                     % ?Task
            task_object/2,              % ?Affordance, ?Task
            grasp_affordance/2,         % ?Affordance, ?Task
            avoided_affordance/2,       % ?Affordance, ?Task
            with_knowledge/2,           % +Knowledge, :Goal
            knowledge_in_use/1,         % -Knowledge
            learn/4,                    % +Knowledge, +Subject, +Property, +Object
            forget/2                    % +Knowledge, ?Subject
          ]).

:- meta_predicate with_knowledge(+, 0).

:- dynamic stored/4.                    % Subject, Property, Object, Knowledge

%!  triple(?Subject, ?Property, ?Object) is nondet.
%
%   A statement of the knowledge base in use.

triple(Subject, Property, Object) :-
    knowledge_in_use(Knowledge),
    stored(Subject, Property, Object, Knowledge).

%!  task(?Task) is nondet.

task(Task) :-
    triple(Task, type, 'Task').

%!  task_object(?Affordance, ?Task) is nondet.
%
%   An object for Task must have a part with Affordance.

task_object(Affordance, Task) :-
    triple(Task, requiresAffordance, Affordance).

%!  grasp_affordance(?Affordance, ?Task) is nondet.
%
%   A part with Affordance can be held for Task.

grasp_affordance(Affordance, Task) :-
    triple(Task, hasGraspAffordance, Affordance).

%!  avoided_affordance(?Affordance, ?Task) is nondet.
%
%   A part with Affordance is left free for Task.

avoided_affordance(Affordance, Task) :-
    triple(Task, avoidsAffordance, Affordance).

%!  with_knowledge(+Knowledge, :Goal) is semidet.
%
%   Prove Goal once, with triple/3 answering from Knowledge.

with_knowledge(Knowledge, Goal) :-
    setup_call_cleanup(
        nb_setval(knowledge_in_use, Knowledge),
        once(Goal),
        nb_delete(knowledge_in_use)).

%!  knowledge_in_use(-Knowledge) is semidet.

knowledge_in_use(Knowledge) :-
    nb_current(knowledge_in_use, Knowledge).

%!  learn(+Knowledge, +Subject, +Property, +Object) is det.
%
%   Add a statement; one that is known stays as it is.

learn(Knowledge, Subject, Property, Object) :-
    (   stored(Subject, Property, Object, Knowledge)
    ->  true
    ;   assertz(stored(Subject, Property, Object, Knowledge))
    ).

%!  forget(+Knowledge, ?Subject) is det.
%
%   Drop every statement about Subject, or all of them when it is unbound.

forget(Knowledge, Subject) :-
    retractall(stored(Subject, _, _, Knowledge)).
