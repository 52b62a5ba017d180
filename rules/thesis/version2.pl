/*  Rule set `thesis`, reasoning Version 2: one rule per part affordance.

    Source: Code A.2 of the thesis, values unchanged. Small readings of ours:

    - Affordance names are those of the interface: pap:'AffordWgrasp' is
      wrap_grasp, pap:'AffordGrasp' is grasp, and so on.
    - hard_condition_min, which the listing uses once without defining it, is
      read as min_dimension.
    - The listing's last clause, partAffordance(Affordance, Task), asks the
      ontology; it lives in relations.pl together with Code A.3.
*/

:- module(thesis_version2, [partAffordance/2]).
:- use_module('../predicates').

%!  partAffordance(?ID, ?Affordance) is nondet.
%
%   Part ID can serve as Affordance.

partAffordance(ID, grasp) :-
    primitive_values(ID, _, Dim, _, Semantic_shape),
    min_dimension(Dim, [0.001, 0.01, 0.04]),
    max_dimension(Dim, [0.05, 0.05, 1]),
    min_ratio(Dim, 2),
    (   Semantic_shape == cylinder
    ;   Semantic_shape == cuboid
    ).

partAffordance(ID, wrap_grasp) :-
    primitive_values(ID, _, Dim, _, Semantic_shape),
    min_dimension(Dim, [0.05, 0.05, 0.05]),
    min_ratio(Dim, 2),
    Semantic_shape == cylinder.

partAffordance(ID, contain) :-
    primitive_values(ID, _, Dim, _, Semantic_shape),
    Semantic_shape == cylinder,
    min_dimension(Dim, [0.03, 0.03, 0.03]),
    max_shape(ID).

partAffordance(ID, pound) :-
    primitive_values(ID, _, Dim, _, Semantic_shape),
    min_dimension(Dim, [0.015, 0.015, 0.015]),
    (   Semantic_shape == cylinder
    ;   Semantic_shape == cuboid
    ).

partAffordance(ID, support) :-
    primitive_values(ID, _, Dim, _, _),
    min_dimension(Dim, [0.0, 0.05, 0.05]),
    max_dimension(Dim, [0.03, 1, 1]),
    min_ratio(Dim, 3).

partAffordance(ID, scoop) :-
    primitive_values(ID, _, Dim, _, _),
    min_dimension(Dim, [0.01, 0.01, 0.01]),
    max_dimension(Dim, [0.1, 0.1, 0.1]),
    max_ratio(Dim, 2).


/*  Not in A.2: cut.

    Chapter 6.2 gives the structure of this rule (Code 6.3) and leaves every
    value open. The values are ours, and describe a flat slab:

    - At most 10 mm thick as recovered (steel is 1 to 3 mm, a depth camera adds
      the rest), 10 to 60 mm wide, 50 to 400 mm long: from the blade of small
      scissors to a chef's knife. A turner's blade is wider, a spoon's handle
      narrower.
    - Ten times as long as thick; together with the thickness this leaves out
      hammer handles and bottles.
    - A cuboid.
*/

partAffordance(ID, cut) :-
    primitive_values(ID, _, Dim, _, Semantic_shape),
    min_dimension(Dim, [0.0, 0.01, 0.05]),
    max_dimension(Dim, [0.01, 0.06, 0.40]),
    min_ratio(Dim, 10),
    Semantic_shape == cuboid.
