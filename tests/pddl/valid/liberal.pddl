;; What planners accept without a word: no requirements, untyped names, either, no condition, bare total-cost.
(define (domain liberal)
  (:types crate pallet - surface surface robot)
  (:constants ground)
  (:predicates
    (on ?x - (either crate pallet) ?y - surface) (marked ?x) (ready) (unused ?x))
  (:functions (weight ?c - crate) - number (total-cost) (energy) - number)
  (:action wait
    :parameters ()
    :precondition ()
    :effect (ready))
  (:action mark
    :parameters (?x)
    :precondition (and (not (marked ?x)) (not (= ?x ground)) (imply (ready) (ready)))
    :effect (and (marked ?x) (increase total-cost 1) (marked ground)))
  (:action stack
    :parameters (?r - robot ?c - crate ?s ?t - surface)
    :precondition (and
      (on ?c ?s)
      (or (= ?s ?t) (exists (?o - crate) (on ?o ?t)))
      (forall (?o - crate) (marked ?o))
      (>= (energy) (- (weight ?c) -1.5)))
    :effect (and
      (on ?c ?t)
      (forall (?o - crate) (when (on ?o ?c) (not (marked ?o))))
      (decrease (energy) (/ (weight ?c) 2))
      (increase (total-cost) (weight ?c)))))
