; A student does things where they can be done; only the walks are seen.
(define (domain errands)
  (:requirements :strips :typing)
  (:types place task)
  (:predicates (here ?p - place) (near ?a ?b - place) (possible ?t - task ?p - place) (after ?t ?s - task) (done ?t - task))
  (:action walk
    :parameters (?a ?b - place) :precondition (and (here ?a) (near ?a ?b))
    :effect (and (here ?b) (not (here ?a))))
  (:action begin
    :parameters (?t ?s - task ?p - place) :precondition (and (here ?p) (possible ?t ?p) (after ?t ?s) (done ?s))
    :effect (done ?t)))
