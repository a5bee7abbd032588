(define (domain d)
  (:requirements :strips :derived-predicates :constraints :time)
  (:predicates (p) (q))
  (:constraints (always (p)))  ;; expect: unsupported
  (:derived (q) (p))  ;; expect: unsupported
  (:process burn :parameters () :effect (p))  ;; expect: unsupported
  (:event bang :parameters () :effect (p))  ;; expect: unsupported
  (:action act :parameters () :effect (p)))
