/*  The door: one JSON text in, one JSON text out.

    Names and numbers of a request arrive as data inside that text and are never
    part of a goal, so nothing in them can be executed. Whatever goes wrong comes
    back as an error in the answer; the parts of a request are withdrawn however
    it ends.
*/

:- module(service, [answer/2]).         % +Request, -Answer
:- use_module(decide).
:- use_module(explain, [with_memory/1]).
:- use_module(reading, [called_rule/3]).
:- use_module(json_text).
:- use_module(learned).
:- use_module(predicates).
:- use_module(quantities).
:- use_module(relations).
:- use_module(rule_file).
:- use_module(rule_sets).
:- use_module(vocabulary, [words/1]).
:- use_module(wholes).
:- use_module(library(apply)).
:- use_module(library(http/json)).
:- use_module(library(lists)).
:- use_module(library(prolog_code)).

%   A decision needs a megabyte or two and leaves nothing behind: with room for a few, no
%   garbage is collected in the middle of one.

:- set_prolog_stack(global, min_free(8 000 000)).

%!  answer(+Request, -Answer) is det.
%
%   Request is a JSON object with an operation and its arguments, Answer one
%   with `status` ok and the result, or with `status` error, the error's kind
%   and messages. Both are text. Output that a rule writes is swallowed.

answer(Request, Answer) :-
    with_output_to(string(_), replied(Request, Reply)),
    json_text(Reply, Answer).

replied(Request, Reply) :-
    catch(( understood(Request, Asked), performed(Asked, Reply) ),
          Error,
          error_reply(Error, Reply)),
    !.
replied(_, reply{status: error, kind: failed, messages: ["the operation failed"]}).

understood(Request, Asked) :-
    atom_json_dict(Request, Asked, [value_string_as(atom)]).

performed(Asked, Reply) :-
    operation(Asked.operation, Asked, Result),
    Reply = reply{status: ok, result: Result}.

error_reply(bad_rules(Messages), reply{status: error, kind: bad_rules, messages: Messages}) :- !.
error_reply(too_long(Limit), reply{status: error, kind: too_long, messages: [Message]}) :-
    !,
    format(string(Message), "no end within ~D inferences", [Limit]).
error_reply(Error, reply{status: error, kind: prolog, messages: [Message]}) :-
    message_to_codes_safely(Error, Message).

message_to_codes_safely(Error, Message) :-
    catch(( '$messages':translate_message(Error, Lines, []),
            with_output_to(string(Message),
                           ( current_output(Out), print_message_lines(Out, '', Lines) )) ),
          _, fail),
    !.
message_to_codes_safely(Error, Message) :-
    format(string(Message), "~q", [Error]).

                /*******************************
                *          OPERATIONS          *
                *******************************/

%   load: read a rule set; says which tasks and affordances it has rules for, and which
%   affordances' rules ask for another affordance.

operation(load, Asked, Result) :-
    load_rule_set(Asked.directory, Asked.rule_set),
    findall(Task, ruled_task(Asked.rule_set, Task), Tasks0),
    findall(Affordance, ruled_affordance(Asked.rule_set, Affordance), Affordances0),
    sort(Tasks0, Tasks),
    sort(Affordances0, Affordances),
    rule_module(Asked.rule_set, v2, Module),
    findall([Affordance, Other],
            called_rule(Module, partAffordance(_, Affordance), partAffordance(_, Other)),
            Uses),
    Result = rules{tasks: Tasks, affordances: Affordances, uses: Uses}.

%   change: what a knowledge base forgets (everything, subjects of statements, rules) and
%   what it learns, in one step.

operation(change, Asked, changed{}) :-
    Knowledge = Asked.knowledge,
    (   Asked.clear == true
    ->  forget(Knowledge, _),
        unteach_rule(Knowledge, _)
    ;   forall(member(Subject, Asked.subjects), forget(Knowledge, Subject)),
        forall(member(Name, Asked.names), unteach_rule(Knowledge, Name))
    ),
    forall(member([Subject, Property, Object], Asked.triples),
           learn(Knowledge, Subject, Property, Object)),
    forall(member(Rule, Asked.rules), teach_rule(Knowledge, Rule)).

%   clauses: the named learned rules as Prolog text, by name; all of them if none is named.

operation(clauses, Asked, Clauses) :-
    Names = Asked.names,
    findall(Name-Text,
            ( ( Names == [] -> true ; member(Name, Names) ),
              learned_clause(Asked.knowledge, Name, Text) ),
            Pairs),
    dict_pairs(Clauses, clauses, Pairs).

%   check_file: what is wrong with a file of rules, and what it has rules for.

operation(check_file, Asked, checked{problems: Problems, rules: Rules}) :-
    rule_file_problems(Asked.file, Problems, Found),
    findall([Name, Line], member(Name-Line, Found), Rules).

%   vocabulary: the words of rules that are written as data.

operation(vocabulary, _, vocabulary{words: Words}) :-
    words(Words).

%   decide: the part to hold; with `join`, first of all which parts are pieces of one. If any
%   are, that is the answer, and the caller asks again about the wholes.

operation(decide, Asked, Result) :-
    setup_call_cleanup(
        true,
        ( maplist(state, Asked.parts),
          state_lying(Asked),
          with_knowledge(Asked.knowledge, bounded_decision(Asked, Decision)),
          facts(Asked, Facts) ),
        ( withdraw_parts, withdraw_layout )),
    Result = Decision.put(facts, Facts).

state(Part) :-
    state_part(Part.id, Part.position, Part.dimensions, Part.exponents, Part.shape,
               Part.probability).

%   A request without parts, or from before there was a layout, states none.

state_lying(Asked) :-
    (   get_dict(layout, Asked, Layout),
        is_dict(Layout)
    ->  state_layout(Layout)
    ;   true
    ).

bounded_decision(Asked, Decision) :-
    Limit = Asked.max_inferences,
    Goal = with_memory(joined_or_decided(Asked, Decision)),
    call_with_inference_limit(Goal, Limit, Outcome),
    (   Outcome == inference_limit_exceeded
    ->  throw(too_long(Limit))
    ;   true
    ).

joined_or_decided(Asked, joined{outcome: joined, groups: Groups, traces: Traces}) :-
    get_dict(join, Asked, true),
    wholes(Asked.rule_set, Asked.version, Groups, Traces),
    Groups = [_|_],
    !.
joined_or_decided(Asked, Decision) :-
    decision(Asked.rule_set, Asked.version, Asked.task, Decision).

%   The facts that the rules saw, as one text with a line for each.

facts(Asked, Facts) :-
    with_output_to(string(Facts), forall(fact(Asked, Fact), ( writeq(Fact), nl ))).

fact(_, primitive_values(ID, Position, Dimensions, Exponents, Shape)) :-
    primitive_values(ID, Position, Dimensions, Exponents, Shape).
fact(_, Fact) :-
    layout_fact(Fact).
fact(Asked, Fact) :-
    Asked.version == v2,
    with_knowledge_all(Asked.knowledge, triple(Asked.task, _, _), Triples),
    member(Fact, Triples).

with_knowledge_all(Knowledge, Triple, Triples) :-
    with_knowledge(Knowledge, findall(Triple, Triple, Triples)).
