;; No types at all, and a constant that no fact mentions.
(define (domain untyped)
  (:requirements :strips :negative-preconditions :equality)
  (:constants floor)
  (:predicates (on ?x ?y) (clear ?x))
  (:action move
    :parameters (?x ?from ?to)
    :precondition (and (on ?x ?from) (clear ?x) (clear ?to) (not (= ?x ?to)) (not (= ?x floor)) (not (= ?from ?to)))
    :effect (and (on ?x ?to) (not (on ?x ?from)) (clear ?from) (not (clear ?to)) (clear floor))))
