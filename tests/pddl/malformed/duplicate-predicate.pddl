(define (domain d)
  (:types thing)
  (:predicates
    (p ?x - thing)
    (q)
    (P ?x ?y - thing))  ;; expect: duplicate-predicate
  (:functions (f)
    (f))  ;; expect: duplicate-function
  (:action act :parameters (?x - thing) :precondition (p ?x) :effect (q)))
