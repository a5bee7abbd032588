;; title: a human and a robot put furniture together
;; source: made for these tests
(define (domain workshop)
  (:requirements :strips :typing :negative-preconditions)
  (:types agent part - object)
  (:predicates
    (controllable ?a - agent)
    (fetched ?p - part)
    (fits ?p ?on - part)
    (joined ?p ?on - part)
    (painted ?p - part))
  (:action fetch
    :parameters (?a - agent ?p - part)
    :precondition (not (fetched ?p))
    :effect (fetched ?p))
  (:action join
    :parameters (?a - agent ?p ?on - part)
    :precondition (and (fits ?p ?on) (fetched ?p) (fetched ?on))
    :effect (joined ?p ?on))
  (:action paint
    :parameters (?a - agent ?p - part)
    :precondition (fetched ?p)
    :effect (painted ?p)))
