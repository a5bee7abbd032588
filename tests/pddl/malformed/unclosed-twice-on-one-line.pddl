(define (domain d) (:predicates (p) (q) (:action a :parameters () :precondition (and (p) (q) :effect (r)))  ;; expect: unclosed unknown-predicate
