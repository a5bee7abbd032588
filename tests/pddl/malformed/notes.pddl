;; hrcplan: success ask 0.8
;; hrcplan: success aks 0.8  ;; expect: unknown-note
;; hrcplan: success ask 80  ;; expect: bad-note
;; hrcplan: range mood 10 0  ;; expect: bad-note
;; hrcplan: probability ask 0.8  ;; expect: unknown-note
;; hrcplan: success ASK 0.7  ;; expect: duplicate-note
;; hrcplan: range mood low high  ;; expect: bad-note
;; hrcplan:  ;; expect: unknown-note
(define (domain d)
  (:types agent)
  (:predicates (asked ?a - agent))
  (:functions (mood ?a - agent))
  ;; HRCPLAN: range mood 0 10
  (:action ask :parameters (?a - agent) :effect (asked ?a)))
