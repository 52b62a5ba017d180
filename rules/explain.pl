/*  Proving rules so that the proof can be shown.

    A rule is an ordinary clause of a rule module (thesis/version1.pl and the
    like), read with clause/2. Its body is proved goal by goal by calling each
    goal itself; every condition is recorded with what was measured.

    proof/3     gives the ways in which a rule holds, as Prolog finds them.
    attempt/3   tries a rule on every choice of parts and lets no condition cut
                the rest off; it serves to find the nearest miss.

    A goal that looks up a part (primitive_values) chooses; a goal with clauses
    of its own in the rule module is entered; everything else is a condition.
*/

:- module(explain,
          [ prepare_rules/2,            % +Module, +Title
            rule_about/3,               % ?Module, ?Head, ?Line
            rule_problem/2,             % +Module, -Problem
            proof/3,                    % +Module, ?Head, -Trace
            attempt/3,                  % +Module, ?Head, -Trace
            nearest/2,                  % +Traces, -Nearest
            certainty/2                 % +Conditions, -Certainty
          ]).
:- use_module(measurement).
:- use_module(predicates, [bound/1]).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(option)).
:- use_module(library(pairs)).

:- dynamic prepared/6.          % Module, Head, Steps, Parts, Title, Line

                /*******************************
                *        READING RULES         *
                *******************************/

%!  prepare_rules(+Module, +Title) is det.
%
%   Read the clauses of Module, once after loading. Traces name their rules
%   Title:Task.

prepare_rules(Module, Title) :-
    retractall(prepared(Module, _, _, _, _, _)),
    forall(rule_clause(Module, Head, Body, Ref),
           prepare_rule(Module, Title, Head, Body, Ref)).

rule_clause(Module, Head, Body, Ref) :-
    current_predicate(Module:Name/Arity),
    functor(Head, Name, Arity),
    \+ predicate_property(Module:Head, imported_from(_)),
    clause(Module:Head, Body, Ref).

prepare_rule(Module, Title, Head, Body, Ref) :-
    variable_names(Ref, Module, Head, Body, Names, Line),
    owners(Body, Owners, []),
    steps(Body, Module, Owners, Names, Steps, []),
    part_variables(Owners, Names, Parts),
    assertz(prepared(Module, Head, Steps, Parts, Title, Line)).

%   The names of a clause's variables are only in its source.

variable_names(Ref, Module, Head, Body, Names, Line) :-
    clause_property(Ref, file(File)),
    clause_property(Ref, line_count(Line)),
    catch(read_clause_at(File, Line, Module, Clause, Names), error(_, _), fail),
    plain_clause(Clause, Source),
    Source =@= (Head :- Body),
    !,
    Source = (Head :- Body).
variable_names(_, _, _, _, [], 0).

read_clause_at(File, Line, Module, Clause, Names) :-
    Before is Line - 1,
    setup_call_cleanup(
        open(File, read, Stream, [encoding(utf8)]),
        ( forall(between(1, Before, _), skip(Stream, 0'\n)),
          read_term(Stream, Clause, [variable_names(Names), module(Module)])
        ),
        close(Stream)).

plain_clause((Head :- Body), Source) :- !, Source = (Head :- Body).
plain_clause(Head, (Head :- true)).

%   Which part a variable belongs to: owner(Variable, IDVariable).

owners(Goal, Owners, Tail) :-
    var(Goal),
    !,
    Owners = Tail.
owners((A, B), Owners, Tail) :-
    !,
    owners(A, Owners, Middle),
    owners(B, Middle, Tail).
owners(Goal, Owners, Tail) :-
    finds_part(Goal, ID),
    !,
    term_variables(Goal, Variables),
    foldl(owned_by(ID), Variables, Owners, Tail).
owners(_, Owners, Owners).

owned_by(ID, Variable, [owner(Variable, ID)|Owners], Owners).

finds_part(primitive_values(ID, _, _), ID).
finds_part(primitive_values(ID, _, _, _, _), ID).

%   The named variables that stand for parts, as Name-ID.

part_variables(Owners, Names, Parts) :-
    foldl(part_variable(Owners), Names, Parts, []).

part_variable(Owners, Name = Variable, Parts, Tail) :-
    (   member(owner(_, ID), Owners),
        ID == Variable
    ->  Parts = [Name-ID|Tail]
    ;   Parts = Tail
    ).

%   Steps of a body: find(Goal), enter(Goal), test(Goal, ID, Text).

steps((A, B), Module, Owners, Names, Steps, Tail) :-
    !,
    steps(A, Module, Owners, Names, Steps, Middle),
    steps(B, Module, Owners, Names, Middle, Tail).
steps(true, _, _, _, Steps, Steps) :- !.
steps(Goal, _, _, _, [find(Goal)|Tail], Tail) :-
    finds_part(Goal, _),
    !.
steps(Goal, Module, _, _, [enter(Goal)|Tail], Tail) :-
    callable(Goal),
    functor(Goal, Name, Arity),
    functor(General, Name, Arity),
    \+ predicate_property(Module:General, imported_from(_)),
    predicate_property(Module:General, number_of_clauses(_)),
    !.
steps(Goal, _, Owners, Names, [test(Goal, ID, Text)|Tail], Tail) :-
    about(Goal, Owners, ID),
    as_written(Goal, Names, Text).

about(Goal, Owners, ID) :-
    term_variables(Goal, Variables),
    member(Variable, Variables),
    member(owner(Owned, ID), Owners),
    Owned == Variable,
    !.
about(_, _, none).

as_written(Goal, Names, Text) :-
    term_variables(Goal, Variables),
    foldl(with_blank(Names), Variables, All, Names),
    with_output_to(string(Text), write_goal(Goal, All)).

write_goal((A ; B), Names) :-
    !,
    write_goal(A, Names),
    write(' ; '),
    write_goal(B, Names).
write_goal(Goal, Names) :-
    Goal =.. [Operator, Left, Right],
    current_op(700, xfx, Operator),
    !,
    write_named(Left, Names),
    format(" ~w ", [Operator]),
    write_named(Right, Names).
write_goal(Goal, Names) :-
    write_named(Goal, Names).

write_named(Term, Names) :-
    write_term(Term, [variable_names(Names), quoted(true), spacing(next_argument)]).

with_blank(Names, Variable, All, Tail) :-
    (   member(_ = Named, Names),
        Named == Variable
    ->  All = Tail
    ;   All = ['_' = Variable|Tail]
    ).

%!  rule_about(?Module, ?Head, ?Line) is nondet.
%
%   Module has a rule with this head; Line is where it starts, 0 if unknown.

rule_about(Module, Head, Line) :-
    prepared(Module, Head, _, _, _, Line).

%!  rule_problem(+Module, -Problem) is nondet.
%
%   A rule calls a predicate that does not exist, or gives a bound that is not
%   three numbers. Prolog itself would tell only when the rule is asked.

rule_problem(Module, Problem) :-
    prepared(Module, Head, Steps, _, _, Line),
    member(test(Goal, _, Text), Steps),
    conjunct(Goal, Simple),
    (   \+ predicate_property(Module:Simple, defined),
        functor(Simple, Name, Arity),
        format(string(What), "calls ~w/~w, which is not known", [Name, Arity])
    ;   ( Simple = min_dimension(_, Bound) ; Simple = max_dimension(_, Bound) ),
        nonvar(Bound),
        \+ bound(Bound),
        format(string(What), "has a bound that is not three numbers: ~w", [Text])
    ),
    format(string(Problem), "line ~w: the rule for ~p ~w", [Line, Head, What]).

conjunct(Goal, _) :- var(Goal), !, fail.
conjunct((A , B), Goal) :- !, ( conjunct(A, Goal) ; conjunct(B, Goal) ).
conjunct((A ; B), Goal) :- !, ( conjunct(A, Goal) ; conjunct(B, Goal) ).
conjunct((A -> B), Goal) :- !, ( conjunct(A, Goal) ; conjunct(B, Goal) ).
conjunct(\+ A, Goal) :- !, conjunct(A, Goal).
conjunct(Goal, Goal).

                /*******************************
                *           PROVING            *
                *******************************/

%!  proof(+Module, ?Head, -Trace) is nondet.
%
%   Head, a part and what it is for, holds by a rule of Module; Trace is a dict with the rule, the parts it
%   was proved on and every condition.

proof(Module, Head, Trace) :-
    tried(Module, Head, strictly, true, Trace).

%!  attempt(+Module, ?Head, -Trace) is nondet.
%
%   A rule of Module about Head on some choice of parts, whether it holds or
%   not.

attempt(Module, Head, Trace) :-
    tried(Module, Head, softly, _, Trace).

tried(Module, Head, Manner, Holds, Trace) :-
    prepared(Module, Head, Steps, Parts, Title, _),
    run(Steps, Manner, Module, Conditions, []),
    (   exclude(holds, Conditions, []) -> Holds = true ; Holds = false ),
    Head =.. [_, Part, Subject],
    atomic_list_concat([Title, :, Subject], Rule),
    include(bound_part, Parts, Bound),
    dict_pairs(Bindings, bindings, Bound),
    certainty(Conditions, Certainty),
    Trace = trace{rule: Rule, part: Part, holds: Holds, bindings: Bindings, conditions: Conditions,
                  certainty: Certainty}.

holds(Condition) :-
    true == Condition.holds.

bound_part(_-ID) :-
    integer(ID).

run([], _, _, Conditions, Conditions).
run([Step|Steps], Manner, Module, Conditions, Tail) :-
    step(Step, Manner, Module, Conditions, Middle),
    run(Steps, Manner, Module, Middle, Tail).

step(find(Goal), _, Module, Conditions, Conditions) :-
    call(Module:Goal).
step(enter(Goal), Manner, Module, Conditions, Tail) :-
    prepared(Module, Goal, Steps, _, _, _),
    run(Steps, Manner, Module, Conditions, Tail).
step(test(Goal, ID, Text), strictly, Module, [Condition|Tail], Tail) :-
    call(Module:Goal),
    condition(Goal, ID, Text, true, Condition).
step(test(Goal, ID, Text), softly, Module, [Condition|Tail], Tail) :-
    (   catch(Module:Goal, error(instantiation_error, _), fail)
    *-> Holds = true
    ;   Holds = false
    ),
    condition(Goal, ID, Text, Holds, Condition).

condition(Goal, ID, Text, Holds, Condition) :-
    measurement(Goal, ID, Measurement),
    (   integer(ID) -> Part = ID ; Part = null ),
    Condition = Measurement.put(_{predicate: Text, part: Part, holds: Holds}).

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
