(define (domain d)
  (:predicates (p))
  (:predicates (q))  ;; expect: repeated-section
  (:action go
    :parameters ()
    :effect (p)
    :effect (not (p))))  ;; expect: repeated-section
