; A lift takes people from floor to floor; who has arrived stays there.
(define (domain lift)
  (:requirements :strips :typing)
  (:types floor person)
  (:predicates (lift-at ?f - floor) (waits ?p - person ?f - floor) (wants ?p - person ?f - floor)
    (inside ?p - person) (arrived ?p - person) (next ?a ?b - floor))
  (:action up
    :parameters (?a ?b - floor) :precondition (and (lift-at ?a) (next ?a ?b))
    :effect (and (lift-at ?b) (not (lift-at ?a))))
  (:action down
    :parameters (?a ?b - floor) :precondition (and (lift-at ?a) (next ?b ?a))
    :effect (and (lift-at ?b) (not (lift-at ?a))))
  (:action enter
    :parameters (?p - person ?f - floor) :precondition (and (lift-at ?f) (waits ?p ?f))
    :effect (and (inside ?p) (not (waits ?p ?f))))
  (:action leave
    :parameters (?p - person ?f - floor) :precondition (and (lift-at ?f) (inside ?p) (wants ?p ?f))
    :effect (and (arrived ?p) (not (inside ?p)))))
