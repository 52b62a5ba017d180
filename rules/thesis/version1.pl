/*  Rule set `thesis`, reasoning Version 1: one rule per task.

    Source: Code A.1 of the thesis, values unchanged. Small readings of ours:

    - Task names are those of the interface: the listing's pap:'Cooking' is
      cooking here.
    - The unused fourth and fifth arguments stay as in the listing; the
      predicates are those of predicates.pl, so dimensions are full extents
      and max_shape and min_shape compare enclosed volumes.
    - The tool part of a rule (ID_tool) is what acts, ID is what to hold.
*/

:- module(thesis_version1, [affordTask/2]).
:- use_module('../predicates').

%!  affordTask(?ID, ?Task) is nondet.
%
%   Part ID is the one to hold for Task.

affordTask(ID, cooking) :-
    primitive_values(ID_tool, _, Dim_tool, _, _),
    min_dimension(Dim_tool, [0.0, 0.08, 0.08]),
    max_shape(ID_tool),

    primitive_values(ID, _, Dim, _, Semantic_shape),
    min_ratio(Dim, 1.5),
    max_dimension(Dim, [0.05, 0.05, 1.00]),
    min_dimension(Dim, [0.005, 0.01, 0.05]),
    Semantic_shape == cylinder,
    ID \= ID_tool.

affordTask(ID, hammering) :-
    primitive_values(ID_tool, _, Dim_tool, _, _),
    max_ratio(Dim_tool, 4),

    primitive_values(ID, _, Dim, _, _),
    max_dimension(Dim, [0.07, 0.07, 1.00]),
    min_dimension(Dim, [0.005, 0.01, 0.05]),
    min_ratio(Dim, 1.5),
    max_shape(ID),
    ID_tool \= ID.

affordTask(ID, pouring) :-
    primitive_values(ID, _, Dim, _, Semantic_shape),
    max_shape(ID),
    min_ratio(Dim, 1.5),
    max_dimension(Dim, [0.08, 0.08, 1.00]),
    min_dimension(Dim, [0.03, 0.03, 0.03]),
    Semantic_shape == cylinder.

affordTask(ID, scooping) :-
    primitive_values(ID_tool, _, Dim_tool, _, _),
    max_ratio(Dim_tool, 2),
    min_dimension(Dim_tool, [0.01, 0.01, 0.01]),

    primitive_values(ID, _, Dim, _, _),
    max_dimension(Dim, [0.005, 0.03, 1.00]),
    min_dimension(Dim, [0.00, 0.00, 0.03]),
    ID \= ID_tool.

affordTask(ID, turning) :-
    primitive_values(ID_tool, _, Dim_tool, _, _),
    max_dimension(Dim_tool, [0.03, 0.1, 0.1]),
    min_dimension(Dim_tool, [0.00, 0.03, 0.03]),

    primitive_values(ID, _, Dim, _, Semantic_shape),
    min_ratio(Dim, 2),
    max_dimension(Dim, [0.04, 0.04, 1.00]),
    min_dimension(Dim, [0.00, 0.00, 0.03]),
    (   Semantic_shape == cylinder
    ;   Semantic_shape == cuboid
    ),
    ID \= ID_tool.

affordTask(ID, handover) :-
    primitive_values(ID, _, _, _, _),
    min_shape(ID).


/*  Not in A.1: cutting.

    Chapter 6.2 gives the structure of this rule (Code 6.1: which predicates, on
    which two parts) and leaves every value open. The values are ours:

    - The handle is the handle of the thesis's cooking rule, in its thickness
      (5 to 50 mm), length (from 50 mm) and elongation (from 1.5). It may be up
      to 100 mm wide, for the two rings of scissors lie side by side.
    - It is a cylinder or a cuboid, as the thesis asks of a part to grasp
      (Code A.2); knife scales and scissor rings are flat.
    - The blade is only known by its elongation, as in Code 6.1: 12 times as long
      as thick, so that a 90 mm blade passes up to 7.5 mm of recovered thickness.
      Pans, bottles and heads of hammers are far from it; a long thin handle
      passes as well, which the structure of Code 6.1 cannot prevent.
*/

affordTask(ID, cutting) :-
    primitive_values(ID, _, Dim, _, Semantic_shape),
    min_dimension(Dim, [0.005, 0.01, 0.05]),
    max_dimension(Dim, [0.05, 0.10, 1.00]),
    min_ratio(Dim, 1.5),
    (   Semantic_shape == cylinder
    ;   Semantic_shape == cuboid
    ),

    primitive_values(ID_tool, _, Dim_tool, _, _),
    min_ratio(Dim_tool, 12),
    ID \= ID_tool.
