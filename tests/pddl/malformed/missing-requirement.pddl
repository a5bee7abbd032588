(define (domain d)
  (:requirements :strips :action-costs)
  (:types place)
  (:predicates (at ?p - place))  ;; expect: missing-requirement
  (:functions (fuel) (total-cost))
  (:action go
    :parameters (?p ?q - place)
    :precondition (and
      (not (at ?q))  ;; expect: missing-requirement
      (not (= ?p ?q))  ;; expect: missing-requirement
      (or (at ?p) (at ?q))  ;; expect: missing-requirement
      (exists (?r - place) (at ?r))  ;; expect: missing-requirement
      (forall (?r - place) (at ?r))  ;; expect: missing-requirement
      (> (fuel) 0))  ;; expect: missing-requirement
    :effect (and
      (when (at ?p) (at ?q))  ;; expect: missing-requirement
      (increase (total-cost) 1))))
