(define (domain d)
  (:predicates (p) (q))
  (:action act :parameters () :effect (p))
  (:action other :parameters () :effect (q))
  (:action ACT :parameters () :effect (q)))  ;; expect: duplicate-action
