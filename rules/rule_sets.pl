/*  Loading rule sets.

    A rule set is a folder with version1.pl (module <set>_version1,
    affordTask/2 clauses for tasks) and version2.pl (module <set>_version2,
    partAffordance/2 clauses for affordances). Both may use other files of that
    folder; their clauses are part of the proofs.

    Beside these, a version may say, as clauses of its own:

        one_with(ID, Other)     the two are pieces of one part; the rules are asked about
                                the whole
        held_together(Task)     all the parts that may be held for Task are one
                                region; without it each is a region of its own
        goes_with(ID, Other)    part ID is held where Other is held (Version 2: unless
                                Task avoids it)
        held_if_alone(Task)     (Version 2) parts that Task avoids are held all
                                the same when the object offers nothing else
*/

:- module(rule_sets,
          [ load_rule_set/2,            % +Directory, +RuleSet
            rule_module/3,              % +RuleSet, +Version, -Module
            held_together/3,            % +RuleSet, +Version, +Task
            held_if_alone/3,            % +RuleSet, +Version, +Task
            ruled_task/2,               % +RuleSet, ?Task
            ruled_affordance/2          % +RuleSet, ?Affordance
          ]).
:- use_module(reading).
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
    prepare_beside(Directory, RuleSet, Module),
    findall(Problem,
            ( ( Checked = Module ; file_beside(Directory, RuleSet, Module, Checked, _) ),
              rule_problem(Checked, What), format(string(Problem), "~w: ~w", [File, What]) ),
            Problems),
    (   Problems == []
    ->  true
    ;   throw(bad_rules(Problems))
    ).

%   Other files of the folder that the module uses.

prepare_beside(Directory, RuleSet, Module) :-
    forall(file_beside(Directory, RuleSet, Module, Other, Title), prepare_rules(Other, Title)).

file_beside(Directory, RuleSet, Module, Other, Title) :-
    setof(Imported,
          Head^( predicate_property(Module:Head, imported_from(Imported)) ),
          Imports),
    member(Other, Imports),
    module_property(Other, file(File)),
    atomic_list_concat([Directory, /, RuleSet, /], Prefix),
    atom_concat(Prefix, _, File),
    file_base_name(File, Base),
    file_name_extension(Name, _, Base),
    atomic_list_concat([RuleSet, /, Name], Title).

version_file(v1, version1).
version_file(v2, version2).

%!  rule_module(+RuleSet, +Version, -Module) is det.

rule_module(RuleSet, Version, Module) :-
    version_file(Version, Base),
    atomic_list_concat([RuleSet, '_', Base], Module).

%!  held_together(+RuleSet, +Version, +Task) is semidet.

held_together(RuleSet, Version, Task) :-
    says(RuleSet, Version, held_together(Task)).

%!  held_if_alone(+RuleSet, +Version, +Task) is semidet.

held_if_alone(RuleSet, Version, Task) :-
    says(RuleSet, Version, held_if_alone(Task)).

says(RuleSet, Version, Statement) :-
    rule_module(RuleSet, Version, Module),
    rule_about(Module, Statement, _),
    !,
    call(Module:Statement).

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
