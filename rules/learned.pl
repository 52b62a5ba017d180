/*  Rules that are taught while the service runs.

    A rule arrives as a dict of names and numbers and is stored as the steps that
    explain.pl proves, so that it is proved and explained like a rule of a file.
    Every goal comes from vocabulary.pl. Learned rules belong to a knowledge base
    (relations.pl) and count in every rule set.

    The affordance that a condition `affords` asks for is decided by the rules of
    the rule set in use and the learned ones. Learned rules therefore run in a
    module of their own for each module they are asked beside, which remembers
    the rule set.
*/

:- module(learned,
          [ teach_rule/2,               % +Knowledge, +Rule
            unteach_rule/2,             % +Knowledge, ?Name
            learned_clause/3            % +Knowledge, ?Name, -Text
          ]).
:- use_module(explain, [steps_hold_for_part/3]).
:- use_module(predicates, [by_size/3]).
:- use_module(reading).
:- use_module(relations, [knowledge_in_use/1]).
:- use_module(vocabulary).
:- use_module(library(apply)).
:- use_module(library(lists)).

:- dynamic taught/7.            % Subject, Head, Knowledge, Steps, Parts, Title, Name
:- dynamic holds/5.             % Subject, Head, Knowledge, Name, In
:- dynamic runs_in/3.           % Module, In, Shipped

%!  teach_rule(+Knowledge, +Rule) is det.
%
%   Rule is a dict: name; head (affordTask or partAffordance) and subject, what
%   it is for; part, the name of the part to hold; and conditions, a list of
%   dicts with condition (a word of the vocabulary), of (names of parts) and
%   value.
%
%   @throws existence_error for a word that the vocabulary does not have.

teach_rule(Knowledge, Rule) :-
    built(Rule, Head, Steps, Parts),
    version_name(Rule.head, Version),
    atomic_list_concat([learned, /, Rule.name, /, Version], Title),
    assertz(taught(Rule.subject, Head, Knowledge, Steps, Parts, Title, Rule.name)),
    (   plain_body(Steps, Body)
    ->  true
    ;   Body = steps_hold_for_part(Steps, In, Head)
    ),
    assertz((holds(Rule.subject, Head, Knowledge, Rule.name, In) :- Body)).

%   A rule that only looks at parts and enters no other is kept as a clause as well: with
%   many of them known, labels (explain:holds_for_part/2) need not interpret each.

plain_body([find(Goal)|Steps], (Found, once(Body))) :-
    found_with_size(Goal, Found, Size),
    plain_steps(Steps, [Size], Body).

plain_steps([], _, true).
plain_steps([find(Goal)|Steps], Sizes, (Found, Body)) :-
    found_with_size(Goal, Found, Size),
    plain_steps(Steps, [Size|Sizes], Body).
plain_steps([test(Goal, _, _)|Steps], Sizes, (Test, Body)) :-
    (   member(Dim-Size, Sizes),
        arg(1, Goal, Same),
        Same == Dim,
        by_size(Goal, Size, Comparison)
    ->  Test = Comparison
    ;   Test = vocabulary:Goal
    ),
    plain_steps(Steps, Sizes, Body).

found_with_size(Goal, (predicates:Goal, predicates:part_size(ID, T, W, L)), Dim-size(T, W, L)) :-
    Goal = primitive_values(ID, _, Dim, _, _).

%!  unteach_rule(+Knowledge, ?Name) is det.
%
%   Forget a rule, or all when Name is unbound.

unteach_rule(Knowledge, Name) :-
    retractall(taught(_, _, Knowledge, _, _, _, Name)),
    retractall(holds(_, _, Knowledge, Name, _)).

version_name(affordTask, version1).
version_name(partAffordance, version2).

                /*******************************
                *      FROM DATA TO GOALS      *
                *******************************/

built(Rule, Head, Steps, Parts) :-
    mentioned(Rule, Named),
    maplist(part_of_rule, Named, Known),
    memberchk(known(Rule.part, part(ID, _, _), _), Known),
    head(Rule.head, ID, Rule.subject, Head),
    foldl(variable_names, Known, Names, []),
    foldl(condition_steps(Known, Names), [held|Rule.conditions], Nested, [], _),
    append(Nested, Steps),
    maplist(binding, Known, Parts).

head(affordTask, ID, Task, affordTask(ID, Task)).
head(partAffordance, ID, Affordance, partAffordance(ID, Affordance)).

%   The names of the parts in the order in which they are looked for; the one to
%   hold comes first.

mentioned(Rule, Named) :-
    findall(Name, ( member(Condition, Rule.conditions), member(Name, Condition.of) ), Others),
    list_to_set([Rule.part|Others], Named).

part_of_rule(Name, known(Name, part(_, _, _), Found)) :-
    Found = primitive_values(_, _, _, _, _).

binding(known(Name, part(ID, _, _), _), Name-ID).

variable_names(known(Name, part(ID, Dim, Shape), Found), [IDs, Dims, Shapes|Tail], Tail) :-
    Found = primitive_values(ID, _, Dim, _, Shape),
    maplist(variable_name(Name), ['ID_' = ID, 'Dim_' = Dim, 'Shape_' = Shape],
            [IDs, Dims, Shapes]).

variable_name(Name, Prefix = Variable, Full = Variable) :-
    atom_concat(Prefix, Name, Full).

%   A part is looked for right before the first condition that is about it.

condition_steps([First|_], _, held, [find(Found)], Seen0, Seen) :-
    !,
    First = known(Name, _, Found),
    Seen = [Name|Seen0].
condition_steps(Known, Names, Condition, Steps, Seen0, Seen) :-
    maplist(lookup(Known), Condition.of, Parts),
    goal(Condition.condition, Parts, Condition.value, Goal),
    foldl(find_new(Known), Condition.of, Finds, Seen0, Seen),
    append(Finds, Before),
    Parts = [part(ID, _, _)|_],
    test_or_enter(Goal, ID, Names, Step),
    append(Before, [Step], Steps).

lookup(Known, Name, Part) :-
    memberchk(known(Name, Part, _), Known).

find_new(_, Name, [], Seen, Seen) :-
    memberchk(Name, Seen),
    !.
find_new(Known, Name, [find(Found)], Seen, [Name|Seen]) :-
    memberchk(known(Name, _, Found), Known).

goal(Name, Parts, Value, Goal) :-
    (   word(Name, Parts, _, Value, Built, _)
    ->  Goal = Built
    ;   length(Parts, Number),
        throw(error(existence_error(word, Name/Number), _))
    ).

test_or_enter(Goal, _, _, enter(Goal)) :-
    Goal = partAffordance(_, _),
    !.
test_or_enter(\+ Goal, ID, Names, deny(Goal, ID, Text)) :-
    !,
    as_written(\+ Goal, Names, Text).
test_or_enter(Goal, ID, Names, test(Goal, ID, Text)) :-
    as_written(Goal, Names, Text).

                /*******************************
                *           PROVING            *
                *******************************/

%   Learned rules beside those of a module, and inside learned rules the affordances
%   that the files define.

reading:further_rule(Module, Head, Steps, Parts, Title, In) :-
    for(Head, Subject),
    knowledge_in_use(Knowledge),
    run_module(Module, In, _),
    taught(Subject, Head, Knowledge, Steps, Parts, Title, _).
explain:further_part(Module, Head) :-
    for(Head, Subject),
    knowledge_in_use(Knowledge),
    run_module(Module, In, _),
    holds(Subject, Head, Knowledge, _, In).
reading:further_rule(Module, Head, Steps, Parts, Title, In) :-
    runs_in(_, Module, In),
    file_rule(In, Head, Steps, Parts, Title, In).

for(affordTask(_, Subject), Subject).
for(partAffordance(_, Subject), Subject).

%   run_module(+Module, -In, -Shipped): learned rules asked beside Module run in In,
%   where every word of the vocabulary is known; the affordances of the same rule
%   set are defined in Shipped.

run_module(Module, In, Shipped) :-
    runs_in(_, Module, Shipped),
    !,
    In = Module.
run_module(Module, In, Shipped) :-
    runs_in(Module, In, Shipped),
    !.
run_module(Module, In, Shipped) :-
    rule_set_of(Module, RuleSet),
    atom_concat(RuleSet, '_version2', Shipped),
    atom_concat(learned_beside_, Module, In),
    add_import_module(In, vocabulary, start),
    assertz(runs_in(Module, In, Shipped)).

rule_set_of(Module, RuleSet) :-
    member(Version, ['_version1', '_version2']),
    atom_concat(RuleSet, Version, Module),
    !.

                /*******************************
                *           SHOWING            *
                *******************************/

%!  learned_clause(+Knowledge, ?Name, -Text) is nondet.
%
%   The rule as an expert would have written it in a file.

learned_clause(Knowledge, Name, Text) :-
    taught(_, Head, Knowledge, Steps, Parts, _, Name),
    foldl(part_names(Steps), Parts, All, []),
    include(used_in(Steps), All, Names),
    maplist(step_text(Names), Steps, Lines),
    as_written(Head, Names, Said),
    atomic_list_concat(Lines, ',\n    ', Body),
    format(string(Text), "~w :-~n    ~w.", [Said, Body]).

part_names(Steps, Name-ID, Names, Tail) :-
    member(find(primitive_values(Found, _, Dim, _, Shape)), Steps),
    Found == ID,
    !,
    variable_names(known(Name, part(ID, Dim, Shape), primitive_values(ID, _, Dim, _, Shape)),
                   Names, Tail).

%   A variable that only looks a part up stays unnamed, but for the part's number.

used_in(_, Name = _) :-
    atom_concat('ID_', _, Name),
    !.
used_in(Steps, _ = Variable) :-
    ( member(test(Goal, _, _), Steps) ; member(enter(Goal), Steps) ),
    term_variables(Goal, Variables),
    member(Same, Variables),
    Same == Variable,
    !.

step_text(Names, find(Goal), Text) :- as_written(Goal, Names, Text).
step_text(Names, enter(Goal), Text) :- as_written(Goal, Names, Text).
step_text(_, deny(_, _, Text), Text).
step_text(_, test(Goal, _, Written), Text) :-
    (   Goal = (_ ; _)
    ->  format(string(Text), "( ~w )", [Written])
    ;   Text = Written
    ).
