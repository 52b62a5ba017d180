/*  Writing an answer as JSON text.

    library(http/json) lays text out for people, which for an answer with its proof
    takes longer than the proof. Prolog's own writer puts a whole term on one line in
    a fraction of that, and a term can be made that it writes as JSON:

        {"name": "x", "sizes": [1, 2]}     is {}(','(':'("name", "x"), ...)) to Prolog

    Escapes of a quote, a backslash or a new line are the same in both. Where another
    occurs, of a bell or the like, the library writes the answer.
*/

:- module(json_text, [json_text/2]).            % +Value, -Text
:- use_module(library(http/json)).

%!  json_text(+Value, -Text) is det.
%
%   Value is made of dicts, lists, strings, numbers and atoms; true, false and null are
%   themselves, other atoms are strings.

json_text(Value, Text) :-
    json_term(Value, Term),
    with_output_to(string(Written), write_term(Term, [quoted(true)])),
    (   split_string(Written, "\\", "", [_|Escaped]),
        escapes(Escaped)
    ->  Text = Written
    ;   with_output_to(string(Text), ( current_output(Out), json_write_dict(Out, Value, [width(0)]) ))
    ).

%   What follows each backslash: all are escapes that JSON has. An empty text lies between
%   the two backslashes of an escaped one.

escapes([]).
escapes([""|Rest]) :-
    !,
    Rest = [_|Escaped],
    escapes(Escaped).
escapes([Text|Rest]) :-
    string_code(1, Text, Code),
    memberchk(Code, `"bfnrt`),
    escapes(Rest).

json_term(Value, Term) :-
    is_dict(Value),
    !,
    dict_pairs(Value, _, Pairs),
    object(Pairs, Term).
json_term(Value, Term) :-
    atom(Value),
    !,
    (   constant(Value)
    ->  Term = Value
    ;   atom_string(Value, Term)
    ).
json_term([First|Rest], [FirstTerm|Terms]) :-
    !,
    json_term(First, FirstTerm),
    json_terms(Rest, Terms).
json_term(Value, Value).

constant([]).
constant(true).
constant(false).
constant(null).

json_terms([], []).
json_terms([Value|Values], [Term|Terms]) :-
    json_term(Value, Term),
    json_terms(Values, Terms).

object([], {}).
object([Pair|Pairs], {Members}) :-
    members(Pairs, Pair, Members).

members([], Pair, Member) :-
    member_term(Pair, Member).
members([Next|Pairs], Pair, (Member, Members)) :-
    member_term(Pair, Member),
    members(Pairs, Next, Members).

member_term(Key-Value, Name : Term) :-
    atom_string(Key, Name),
    json_term(Value, Term).
