:- use_module(library(plunit)).
:- use_module(wholes).
:- use_module(rule_sets).
:- use_module(sketch).
:- use_module(library(lists)).

:- begin_tests(wholes, [setup(ready), cleanup(wipe)]).

ready :-
    module_property(rule_sets, file(File)),
    file_directory_name(File, Directory),
    load_rule_set(Directory, thesis),
    load_rule_set(Directory, default).

in_four_pieces :-
    findall(box([X, 0, 0], [0.05, 0.02, 0.02], []), member(X, [0, 0.05, 0.1, 0.15]), Handle),
    sketch([box([0.24, 0, 0], [0.12, 0.12, 0.05], [])|Handle]).

test(a_chain_is_one, Groups-Number == [[1, 2, 3, 4]]-3) :-
    in_four_pieces,
    wholes(default, v2, Groups, Traces),
    length(Traces, Number).
test(both_versions_agree, One == Other) :-
    in_four_pieces,
    wholes(default, v1, One, _),
    wholes(default, v2, Other, _).
test(proved, Rules == ['default/version2:one_with']) :-
    in_four_pieces,
    wholes(default, v2, _, Traces),
    findall(Rule, ( member(T, Traces), true == T.holds, Rule = T.rule ), All),
    sort(All, Rules).
test(the_thesis_knows_no_wholes, Groups == []) :-
    in_four_pieces,
    wholes(thesis, v2, Groups, _).

:- end_tests(wholes).
