(define (domain d)
  (:types agent)
  (:predicates (free ?a - agent) (busy a - agent))  ;; expect: not-a-variable
  (:action rest
    :parameters (a - agent)  ;; expect: not-a-variable
    :precondition (busy ?a)
    :effect (free ?a)))
