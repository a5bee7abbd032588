(define (domain d)
  (:requirements :strips :derived-predicates :constraints :time)
  (:predicates (p) (q))
  (:constraints (never (p)))  ;; expect: not-a-constraint
  (:axiom :vars () :context (p) :implies (q))  ;; expect: unsupported
  (:derived (q) (p))
  (:process burn :parameters () :effect (p))  ;; expect: not-an-effect
  (:event bang :parameters () :effect (p))
  (:action act :parameters () :effect (p)))
