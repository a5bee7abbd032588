(define (domain d)
  (predicates (p) (q))  ;; expect: unknown-section
  (:action one
    parameters ()  ;; expect: unknown-section
    effect (p))  ;; expect: unknown-section
  (:action two
    :parameters ()
    something  ;; expect: stray-word
    :effect (q)))
