(define (domain d)
  (:predicates (p))
  (:action one :parameters () :effect (p)))
(define (problem x)  ;; expect: outside-define
  (:domain d)
  (:init)
  (:goal (p)))
