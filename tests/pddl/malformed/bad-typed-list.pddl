(define (domain d)
  (:types place item)
  (:constants a b -  ;; expect: bad-typed-list
  )
  (:predicates
    (at ?x - )  ;; expect: bad-typed-list
    (on - place)  ;; expect: empty-typed-list
    (in ?x - (place))  ;; expect: bad-typed-list
    here)  ;; expect: bad-predicate
  (:action go :parameters ?x  ;; expect: not-a-list
    :effect (at a)))
