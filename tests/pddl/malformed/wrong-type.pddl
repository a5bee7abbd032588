(define (domain d)
  (:types agent place item - object truck - agent)
  (:predicates (at ?a - agent ?p - place) (loaded ?t - truck))
  (:functions (effort ?a - agent) (total-cost))
  (:action go
    :parameters (?a - agent ?t - truck ?p - place ?x)
    :precondition (and (at ?t ?p)
      (at ?p ?p)  ;; expect: wrong-type
      (loaded ?a)  ;; expect: wrong-type
      (at ?a ?x))  ;; expect: wrong-type
    :effect (and (loaded ?t)
      (increase (total-cost) (effort ?p)))))  ;; expect: wrong-type
