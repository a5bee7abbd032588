(define (domain d)
  (:types agent place)
  (:predicates (at ?a - agent ?p - place) (open ?p - place))
  (:functions (tiredness ?a - agent) (total-cost))
  (:action open-door  ;; expect: agent-first
    :parameters (?p - place ?a - agent)
    :precondition (at ?a ?p)
    :effect (open ?p))
  (:action wait  ;; expect: agent-first
    :parameters () :effect (increase (total-cost) 1))
  (:action walk
    :parameters (?a - agent ?p - place)
    :effect (and (at ?a ?p)
      (increase (total-cost) (tiredness ?a))
      (increase (tiredness ?a) 1)))  ;; expect: agent-state-change
  (:action cheer
    :parameters (?a ?b - agent)
    :effect (and (decrease (tiredness ?b) 2) (increase (total-cost) 1))))
