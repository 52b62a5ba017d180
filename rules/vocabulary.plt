:- use_module(vocabulary).
:- use_module(quantities, [known_quantity/1]).
:- use_module(library(occurs)).
:- use_module(library(plunit)).

:- begin_tests(vocabulary).

%   The goal of a word on parts number 0 and 1.

built(Name, Number, Value, Goal) :-
    length(Parts, Number),
    Given = [part(0, [0.1, 0.2, 0.3], cuboid), part(1, [0.1, 0.1, 0.1], sphere)],
    append(Parts, _, Given),
    once(word(Name, Parts, _, Value, Goal, _)).

test(names_are_unique) :-
    findall(Name, word(Name, _, _, _, _, _), Names),
    sort(Names, Unique),
    length(Names, Count),
    length(Unique, Count).

%   Every goal exists, or is a rule about affordances, and asks for quantities that are known.

test(goals_exist, [forall(named(Name)), nondet]) :-
    values(Name, Value),
    word(Name, _, _, Value, Goal, _),
    exists(Goal).

named(Name) :- word(Name, _, _, _, _, _).

values(shape, [sphere, cuboid]) :- !.
values(_, _).

exists(\+ Goal) :- !, exists(Goal).
exists((A ; B)) :- !, exists(A), exists(B).
exists(partAffordance(_, _)).
exists(at_least(Quantity, _)) :- !, known_quantity(Quantity).
exists(at_most(Quantity, _)) :- !, known_quantity(Quantity).
exists(Goal) :- predicate_property(vocabulary:Goal, defined).

%   Whatever can be measured on parts can be asked for.

test(every_quantity_has_a_word, [forall(quantity_of_parts(Quantity)), nondet]) :-
    word(_, _, number(_, _, _, _), _, at_least(Term, _), _),
    sub_term(Part, Term),
    nonvar(Part),
    functor(Part, Quantity, _).

quantity_of_parts(Quantity) :-
    clause(quantities:quantity(General, _, _), _),
    compound(General),
    General \= _ / _,
    functor(General, Quantity, _).

test(number, true(Goal == min_ratio([0.1, 0.2, 0.3], 2))) :-
    built(min_ratio, 1, 2, Goal).
test(quantity, true(Goal == at_least(thickness(0) / width(0), 0.5))) :-
    built(min_flatness, 1, 0.5, Goal).
test(two_parts, true(Goal == at_most(volume(0) / volume(1), 3))) :-
    built(max_relative_volume, 2, 3, Goal).
test(one_class, true(Goal == (cuboid == sphere))) :-
    built(shape, 1, [sphere], Goal).
test(classes, true(Goal == (cuboid == sphere ; cuboid == cylinder))) :-
    built(shape, 1, [sphere, cylinder], Goal).
test(wrong_number_of_parts, fail) :-
    built(different, 1, null, _).
test(nothing_else_is_a_word, [forall(member(Name, [halt, call, shell, consult, (=), assertz])), fail]) :-
    word(Name, _, _, _, _, _).

test(words, true(Said == [number, ratio, min, 1, 1000])) :-
    words(Words),
    member(Word, Words),
    min_ratio == Word.name,
    !,
    Said = [Word.takes, Word.quantity, Word.direction, Word.low, Word.high].

:- end_tests(vocabulary).
