(define (domain d)
  (:predicates (p) (q)  ;; expect: unclosed
  (:action one :parameters () :effect (p)))  ;; expect: stray-parenthesis
  (:action two :parameters () :effect (r)))  ;; expect: unknown-predicate
