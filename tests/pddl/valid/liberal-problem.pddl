(define (problem anything)
  (:domain liberal)
  (:requirements :typing)
  (:objects a b - crate p - pallet r - robot thing)
  (:init
    (on a p) (not (on b p)) (marked thing)
    (= (weight a) +2) (= (weight b) .25) (= (energy) 1e2))
  (:goal (forall (?c - crate) (on ?c p)))
  (:metric minimize total-cost))
