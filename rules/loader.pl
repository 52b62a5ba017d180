/*  Loading Prolog files without overlooking anything.

    Prolog prints a message about a clause that it cannot read, skips it and goes
    on. For rules that would be a task that silently stops working, so here every
    warning and error while loading is collected and becomes an error.

    This file is loaded first and depends on no other.
*/

:- module(loader,
          [ load_checked/1,             % +File
            loaded/2                    % +File, -Complaints
          ]).
:- use_module(library(apply)).
:- use_module(library(lists)).

:- thread_local listening/0.
:- thread_local heard/1.

:- multifile user:message_hook/3.

user:message_hook(_, Kind, Lines) :-
    loader:listening,
    memberchk(Kind, [error, warning]),
    loader:hear(Lines).

hear(Lines) :-
    with_output_to(string(Raw), ( current_output(Out), print_message_lines(Out, '', Lines) )),
    split_string(Raw, "\n", " \t", Parts),
    exclude(==(""), Parts, Kept),
    atomic_list_concat(Kept, ' ', Text),
    assertz(heard(Text)).

%!  load_checked(+File) is det.
%
%   Load File, and what it uses, unless that is loaded and unchanged.
%
%   @throws bad_rules(Messages) if Prolog had anything to complain about.

load_checked(File) :-
    complaints(File, Messages),
    (   Messages == []
    ->  true
    ;   throw(bad_rules(Messages))
    ).

%!  loaded(+File, -Complaints) is det.
%
%   The same, with the complaints as text, one per line; empty if there are none.

loaded(File, Complaints) :-
    complaints(File, Messages),
    atomic_list_concat(Messages, '\n', Complaints).

complaints(File, Messages) :-
    setup_call_cleanup(
        ( retractall(heard(_)), assertz(listening) ),
        catch(load_files(user:File, [if(changed), must_be_module(true), imports([]), encoding(utf8)]),
              Error, print_message(error, Error)),
        retractall(listening)),
    findall(Message, retract(heard(Message)), Messages).
