Here is a domain:  ;; expect: outside-define
(define (domain d)
  (:predicates (p))
  (:action one :parameters () :effect (q)))  ;; expect: unknown-predicate
