/*  Which recovered parts are pieces of one part.

    A rule set says so by one_with(ID, Other), or says nothing; the service then makes
    them one (services/reasoning/wholes.py) and asks about the wholes.
*/

:- module(wholes, [wholes/4]).          % +RuleSet, +Version, -Groups, -Traces
:- use_module(explain, [proof/3]).
:- use_module(reading, [has_rule/2]).
:- use_module(rule_sets, [rule_module/3]).
:- use_module(library(lists)).
:- use_module(library(pairs)).
:- use_module(library(ugraphs)).

%!  wholes(+RuleSet, +Version, -Groups, -Traces) is det.
%
%   Groups are lists of two or more parts that are pieces of one, directly or by others
%   between them; Traces prove it, one for each pair.

wholes(RuleSet, Version, Groups, Traces) :-
    rule_module(RuleSet, Version, Module),
    has_rule(Module, one_with(_, _)),
    !,
    findall((ID-Other)-Trace, pieces(Module, ID, Other, Trace), Proofs),
    pairs_keys_values(Proofs, Pairs, Traces),
    findall(Edge, ( member(ID-Other, Pairs), member(Edge, [ID-Other, Other-ID]) ), Edges),
    vertices_edges_to_ugraph([], Edges, Graph),
    transitive_closure(Graph, Reachable),
    findall(Group, member(_-Group, Reachable), All),
    sort(All, Groups).
wholes(_, _, [], []).

pieces(Module, ID, Other, Trace) :-
    findall((A-B)-T, ( proof(Module, one_with(A, B), T), A < B ), Proofs),
    keysort(Proofs, Sorted),
    group_pairs_by_key(Sorted, Grouped),
    member((ID-Other)-[Trace|_], Grouped).
