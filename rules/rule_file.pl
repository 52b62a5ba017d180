/*  Checking a file of rules that somebody wrote in Prolog.

    Everything that Prolog complains about while it loads the file, and what
    would only show when a rule is asked: predicates that do not exist, bounds
    that are none, no rule at all. Loading a file runs its directives, so this is
    for files on disk and never for what a client sends.
*/

:- module(rule_file,
          [ rule_file_problems/3        % +File, -Problems, -Rules
          ]).
:- use_module(reading).
:- use_module(loader).
:- use_module(library(lists)).

%!  rule_file_problems(+File, -Problems, -Rules) is det.
%
%   Problems are texts that begin with the place, Rules what the file has rules
%   for, as Name-Line.

rule_file_problems(File, Problems, Rules) :-
    (   catch(load_checked(File), bad_rules(Messages), true),
        nonvar(Messages)
    ->  Problems = Messages, Rules = []
    ;   absolute_file_name(File, Path, [file_type(prolog), access(read)]),
        module_property(Module, file(Path)),
        prepare_rules(Module, Module),
        findall(Subject-Line, rule_for(Module, Subject, Line), Rules),
        findall(Problem, problem(Module, Path, Rules, Problem), Problems)
    ).

rule_for(Module, Subject, Line) :-
    ( Head = affordTask(_, Subject) ; Head = partAffordance(_, Subject) ),
    rule_about(Module, Head, Line).

problem(_, Path, [], Problem) :-
    format(string(Problem), "~w: no rule: neither affordTask/2 nor partAffordance/2 has a clause",
           [Path]).
problem(_, Path, Rules, Problem) :-
    member(Subject-Line, Rules),
    \+ atom(Subject),
    format(string(Problem),
           "~w: line ~w: the rule does not say which task or affordance it is for", [Path, Line]).
problem(Module, Path, _, Problem) :-
    rule_problem(Module, What),
    format(string(Problem), "~w: ~w", [Path, What]).
