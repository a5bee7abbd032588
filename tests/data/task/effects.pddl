;; Conditional and universally quantified effects; one that adds and deletes the same fact.
(define (domain effects)
  (:requirements :adl :typing :action-costs)
  (:types block place)
  (:predicates (at ?b - block ?p - place) (wet ?b - block) (hot ?p - place) (near ?p ?q - place) (lost))
  (:functions (total-cost) (way ?p ?q - place))
  (:action push
    :parameters (?p ?q - place)
    :precondition (near ?p ?q)
    :effect (and
      (forall (?b - block) (when (at ?b ?p) (and (at ?b ?q) (not (at ?b ?p)))))
      (forall (?b - block) (when (and (at ?b ?p) (or (hot ?q) (not (wet ?b)))) (wet ?b)))
      (increase (total-cost) (+ (way ?p ?q) 0.5))))
  (:action dry
    :parameters (?p - place)
    :precondition (hot ?p)
    :effect (and (forall (?b - block) (when (at ?b ?p) (not (wet ?b)))) (not (hot ?p))
      (increase (total-cost) 2)))
  (:action heat
    :parameters (?p - place)
    :effect (and (hot ?p) (forall (?q - place) (when (near ?p ?q) (not (hot ?q)))) (increase (total-cost) 1)))
  (:action renew
    :parameters (?b - block)
    :effect (and (wet ?b) (not (wet ?b)) (when (lost) (not (lost)))))
  (:action lose
    :parameters ()
    :precondition (not (lost))
    :effect (and (lost) (when (exists (?p - place) (hot ?p)) (forall (?b - block) (not (wet ?b)))))))
