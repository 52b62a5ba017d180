:- use_module(library(plunit)).
:- use_module(library(http/json)).
:- use_module(json_text).

:- begin_tests(json_text).

again(Value, Read) :-
    json_text(Value, Text),
    atom_json_dict(Text, Read, []).

test(values, Read == [1, -2.5, 1.0e-9, true, null, [], "a"]) :-
    again([1, -2.5, 1.0e-9, true, null, [], a], Read).
test(dicts, Read =@= _{one: 1, other: _{list: [[], [0]]}}) :-
    again(_{one: 1, other: _{list: [[], [0]]}}, Read).
test(escapes) :-
    forall(member(Text, ["a \"b\"", "\\+ c", "line\nline\ttab", "\u0001\u001f\u007f", "\\\\", "\\\"", "\\a", "'", "h\u00e9, \u4e2d"]),
           again([Text], [Text])).
test(one_line) :-
    json_text(_{text: "a\nb", list: [1, 2]}, Text),
    \+ sub_string(Text, _, _, _, "\n").

:- end_tests(json_text).
