(define (problem multiple-vars-forall-problem)
(:domain multiple-vars-forall)
(:objects
l1 l2 l3 - location
)
(:init
(safe l1 l1)
(safe l2 l2)
(safe l3 l3)
)
(:goal ()
)
)
