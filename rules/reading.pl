/*  Rules as they are read, once: what proofs (explain.pl) go through.

    A rule is an ordinary clause of a rule module (thesis/version1.pl and the
    like), read with clause/2 and kept as steps:

        find(Goal)              looks up a part (primitive_values, part): chooses
        enter(Goal)             has clauses of its own, in the rule module or in a
                                file beside it: is entered
        deny(Goal, ID, Text)    the negation of such a goal: a condition
        test(Goal, ID, Text)    everything else: a condition

    ID is the part that a condition is about, Text how it is written in the file.
*/

:- module(reading,
          [ prepare_rules/2,            % +Module, +Title
            rule/6,                     % +Module, ?Head, -Steps, -Parts, -Title, -In
            file_rule/6,                % +Module, ?Head, -Steps, -Parts, -Title, -In
            rule_about/3,               % ?Module, ?Head, ?Line
            has_rule/2,                 % +Module, +Head
            called_rule/3,              % +Module, ?Head, -Called
            finds_part/2,               % +Goal, -ID
            as_written/3,               % +Goal, +Names, -Text
            rule_problem/2              % +Module, -Problem
          ]).
:- use_module(predicates, [bound/1]).
:- use_module(quantities, [known_quantity/1]).
:- use_module(library(apply)).
:- use_module(library(lists)).

:- dynamic prepared/6.          % Module, Head, Steps, Parts, Title, Line
:- dynamic defined_beside/3.    % Module, General, Other: a goal whose rules lie in Other

%   further_rule(+Module, ?Head, -Steps, -Parts, -Title, -In): another rule that counts
%   beside those of Module; its goals are called in the module In.

:- multifile further_rule/6.
:- dynamic further_rule/6.

%!  prepare_rules(+Module, +Title) is det.
%
%   Read the clauses of Module, once after loading. Traces name their rules
%   Title:Task.

prepare_rules(Module, Title) :-
    retractall(prepared(Module, _, _, _, _, _)),
    retractall(defined_beside(Module, _, _)),
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
    entered_variables(Steps, Entered),
    append(Owners, Entered, AllOwners),
    part_variables(AllOwners, Names, Parts),
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

finds_part(part(ID), ID).
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

%   A named variable of a goal that is entered may stand for a part as well; whether it
%   does shows when it is bound.

entered_variables([], []).
entered_variables([Step|Steps], Owners) :-
    (   Step = enter(Goal)
    ->  term_variables(Goal, Variables),
        foldl(owns_itself, Variables, Owners, Rest)
    ;   Owners = Rest
    ),
    entered_variables(Steps, Rest).

owns_itself(Variable, [owner(Variable, Variable)|Owners], Owners).

steps((A, B), Module, Owners, Names, Steps, Tail) :-
    !,
    steps(A, Module, Owners, Names, Steps, Middle),
    steps(B, Module, Owners, Names, Middle, Tail).
steps(true, _, _, _, Steps, Steps) :- !.
steps(Goal, _, _, _, [find(Goal)|Tail], Tail) :-
    finds_part(Goal, _),
    !.
steps(Goal, Module, _, _, [enter(Goal)|Tail], Tail) :-
    has_home(Goal, Module),
    !.
steps(\+ Goal, Module, Owners, Names, [deny(Goal, ID, Text)|Tail], Tail) :-
    has_home(Goal, Module),
    !,
    about(Goal, Owners, ID),
    as_written(Goal, Names, Positive),
    string_concat("\\+ ", Positive, Text).
steps(Goal, _, Owners, Names, [test(Goal, ID, Text)|Tail], Tail) :-
    about(Goal, Owners, ID),
    as_written(Goal, Names, Text).

%   Goal has clauses in Module or in a file beside it; the latter is noted.

has_home(Goal, Module) :-
    callable(Goal),
    functor(Goal, Name, Arity),
    functor(General, Name, Arity),
    (   predicate_property(Module:General, imported_from(Other))
    ->  beside(Module, Other),
        (   defined_beside(Module, General, Other)
        ->  true
        ;   assertz(defined_beside(Module, General, Other))
        )
    ;   Other = Module
    ),
    predicate_property(Other:General, number_of_clauses(_)).

beside(Module, Other) :-
    module_property(Module, file(File)),
    module_property(Other, file(OtherFile)),
    file_directory_name(File, Directory),
    file_directory_name(OtherFile, Directory).

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
    ;   ( Simple = at_least(Quantity, Bound) ; Simple = at_most(Quantity, Bound) ),
        (   \+ known_quantity(Quantity),
            format(string(What), "asks for a quantity that is not known: ~w", [Text])
        ;   nonvar(Bound),
            \+ number(Bound),
            format(string(What), "has a bound that is not a number: ~w", [Text])
        )
    ),
    format(string(Problem), "line ~w: the rule for ~p ~w", [Line, Head, What]).

conjunct(Goal, _) :- var(Goal), !, fail.
conjunct((A , B), Goal) :- !, ( conjunct(A, Goal) ; conjunct(B, Goal) ).
conjunct((A ; B), Goal) :- !, ( conjunct(A, Goal) ; conjunct(B, Goal) ).
conjunct((A -> B), Goal) :- !, ( conjunct(A, Goal) ; conjunct(B, Goal) ).
conjunct(\+ A, Goal) :- !, conjunct(A, Goal).
conjunct(Goal, Goal).

%!  has_rule(+Module, +Head) is semidet.
%
%   There is a rule with this head, of Module or learned.

has_rule(Module, Head) :-
    once(rule(Module, Head, _, _, _, _)).

%!  called_rule(+Module, ?Head, -Called) is nondet.
%
%   The rule with this head in Module enters rules with the head Called.

called_rule(Module, Head, Called) :-
    prepared(Module, Head, Steps, _, _, _),
    member(enter(Called), Steps).

%!  rule(+Module, ?Head, -Steps, -Parts, -Title, -In) is nondet.
%
%   A rule that counts in Module, of a file or learned. Parts are Name-ID, the named
%   variables that stand for parts; its goals are called in the module In.

rule(Module, Head, Steps, Parts, Title, In) :-
    file_rule(Module, Head, Steps, Parts, Title, In).
rule(Module, Head, Steps, Parts, Title, In) :-
    further_rule(Module, Head, Steps, Parts, Title, In).

%!  file_rule(+Module, ?Head, -Steps, -Parts, -Title, -In) is nondet.
%
%   As rule/6, of the file of Module or of one beside it.

file_rule(Module, Head, Steps, Parts, Title, Module) :-
    prepared(Module, Head, Steps, Parts, Title, _).
file_rule(Module, Head, Steps, Parts, Title, Other) :-
    defined_beside(Module, Head, Other),
    prepared(Other, Head, Steps, Parts, Title, _).
