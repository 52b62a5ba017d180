/*  Loading rule sets.

    A rule set is a folder with version1.pl (module <set>_version1, one
    affordTask/2 clause per task) and version2.pl (module <set>_version2, one
    partAffordance/2 clause per affordance).
*/

:- module(rule_sets,
          [ load_rule_set/2,            % +Directory, +RuleSet
            rule_module/3,              % +RuleSet, +Version, -Module
            ruled_task/2,               % +RuleSet, ?Task
            ruled_affordance/2          % +RuleSet, ?Affordance
          ]).
:- use_module(explain).
:- use_module(loader).
:- use_module(library(lists)).

%!  load_rule_set(+Directory, +RuleSet) is det.
%
%   Load both versions of RuleSet from its folder in Directory.
%
%   @throws bad_rules(Messages) for files that do not load cleanly.

load_rule_set(Directory, RuleSet) :-
    forall(member(Version, [v1, v2]), load_version(Directory, RuleSet, Version)).

load_version(Directory, RuleSet, Version) :-
    version_file(Version, Base),
    atomic_list_concat([Directory, /, RuleSet, /, Base, '.pl'], File),
    rule_module(RuleSet, Version, Module),
    load_checked(File),
    (   module_property(Module, file(_))
    ->  true
    ;   format(string(Missing), "~w does not define the module ~w", [File, Module]),
        throw(bad_rules([Missing]))
    ),
    atomic_list_concat([RuleSet, /, Base], Title),
    prepare_rules(Module, Title),
    findall(Problem,
            ( rule_problem(Module, What), format(string(Problem), "~w: ~w", [File, What]) ),
            Problems),
    (   Problems == []
    ->  true
    ;   throw(bad_rules(Problems))
    ).

version_file(v1, version1).
version_file(v2, version2).

%!  rule_module(+RuleSet, +Version, -Module) is det.

rule_module(RuleSet, Version, Module) :-
    version_file(Version, Base),
    atomic_list_concat([RuleSet, '_', Base], Module).

%!  ruled_task(+RuleSet, ?Task) is nondet.
%
%   Version 1 of RuleSet has a rule for Task.

ruled_task(RuleSet, Task) :-
    rule_module(RuleSet, v1, Module),
    rule_about(Module, affordTask(_, Task), _).

%!  ruled_affordance(+RuleSet, ?Affordance) is nondet.
%
%   Version 2 of RuleSet has a rule for Affordance.

ruled_affordance(RuleSet, Affordance) :-
    rule_module(RuleSet, v2, Module),
    rule_about(Module, partAffordance(_, Affordance), _).
