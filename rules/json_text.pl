/*  Writing an answer as JSON text.

    library(http/json) lays text out for people, which for an answer with its proof
    takes longer than the proof. This writes the same values on one line. What needs
    escapes is left to the library.
*/

:- module(json_text, [json_text/2]).            % +Value, -Text
:- use_module(library(http/json)).
:- use_module(library(lists)).

%!  json_text(+Value, -Text) is det.
%
%   Value is made of dicts, lists, strings, numbers and atoms; true, false and null are
%   themselves, other atoms are strings.

json_text(Value, Text) :-
    with_output_to(string(Text), ( current_output(Out), value(Value, Out) )).

value(Value, Out) :-
    number(Value),
    !,
    write(Out, Value).
value(Value, Out) :-
    is_dict(Value),
    !,
    dict_pairs(Value, _, Pairs),
    put_char(Out, '{'),
    pairs(Pairs, Out),
    put_char(Out, '}').
value([], Out) :-
    !,
    write(Out, []).
value([First|Rest], Out) :-
    !,
    put_char(Out, '['),
    value(First, Out),
    values(Rest, Out),
    put_char(Out, ']').
value(Value, Out) :-
    atom(Value),
    constant(Value),
    !,
    write(Out, Value).
value(Value, Out) :-
    text(Value, Out).

constant(true).
constant(false).
constant(null).

pairs([], _).
pairs([Key-Value], Out) :-
    !,
    pair(Key, Value, Out).
pairs([Key-Value|Pairs], Out) :-
    pair(Key, Value, Out),
    put_char(Out, ','),
    pairs(Pairs, Out).

pair(Key, Value, Out) :-
    text(Key, Out),
    put_char(Out, ':'),
    value(Value, Out).

values([], _).
values([First|Rest], Out) :-
    put_char(Out, ','),
    value(First, Out),
    values(Rest, Out).

text(Text, Out) :-
    (   plain(Text)
    ->  put_char(Out, '"'),
        write(Out, Text),
        put_char(Out, '"')
    ;   text_to_string(Text, String),
        json_write(Out, String)
    ).

%   Neither a quote, a backslash nor a control character.

plain(Text) :-
    special(Special),
    split_string(Text, Special, "", [_]).

term_expansion(special_characters, special(Special)) :-
    numlist(1, 31, Controls),
    append(Controls, [0'", 0'\\, 127], Codes),
    string_codes(Special, Codes).
special_characters.
