:- use_module(service).
:- use_module(predicates).
:- use_module(library(http/json)).
:- use_module(library(plunit)).

:- begin_tests(service, [setup(ready)]).

ready :-
    module_property(service, file(File)),
    file_directory_name(File, Directory),
    asked(_{operation: load, directory: Directory, rule_set: thesis}, Reply),
    "ok" == Reply.status.

asked(Request, Reply) :-
    atom_json_dict(Text, Request, []),
    answer(Text, Answer),
    atom_json_dict(Answer, Reply, []).

request(Task, _{operation: decide, knowledge: test, rule_set: thesis, version: v1, task: Task,
                max_inferences: 1 000 000,
                parts: [_{id: 0, position: [0, 0, 1], dimensions: [0.07, 0.07, 0.2],
                          exponents: [0.1, 1], shape: cylinder, probability: 0.9}]}).

test(decide, true(Outcome == "found")) :-
    request(pouring, Request),
    asked(Request, Reply),
    Outcome = Reply.result.outcome.
test(names_are_data, true(Outcome == "unknown_task")) :-
    request('pouring), halt, x(', Request),
    asked(Request, Reply),
    Outcome = Reply.result.outcome.
test(nothing_is_left_behind, fail) :-
    request(pouring, Request),
    asked(Request, _),
    primitive_values(_, _, _).
test(nothing_is_left_behind_after_an_error, true(Status == "error")) :-
    request(pouring, Request),
    asked(Request.put(max_inferences, none), Reply),
    \+ primitive_values(_, _, _),
    Status = Reply.status.
test(too_long, true(Kind == "too_long")) :-
    request(pouring, Request),
    asked(Request.put(max_inferences, 50), Reply),
    Kind = Reply.kind.
test(not_json, true(sub_string(Answer, _, _, _, "error"))) :-
    answer('{', Answer).
test(unknown_operation, true(Status == "error")) :-
    asked(_{operation: dance}, Reply),
    Status = Reply.status.

:- end_tests(service).
