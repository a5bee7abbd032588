(define (domain d)
  (:predicates (done))
  (:functions (total-cost) (price ?x))
  (:action act
    :parameters (?x)
    :effect (and (done)
      (increase (total-cost) (prize ?x))  ;; expect: unknown-function
      (increase (total-costs) 1))))  ;; expect: unknown-function
