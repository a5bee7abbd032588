;; hrcplan: success ask 0.8
;; A note ends with its line, so what is expected of it stands in the line before.
;; expect next: unknown-note
;; hrcplan: success aks 0.8
;; expect next: bad-note
;; hrcplan: success ask 80
;; expect next: bad-note
;; hrcplan: range mood 10 0
;; expect next: unknown-note
;; hrcplan: probability ask 0.8
;; expect next: duplicate-note
;; hrcplan: success ASK 0.7
;; expect next: bad-note
;; hrcplan: range mood low high
;; expect next: unknown-note
;; hrcplan:
(define (domain d)
  (:types agent)
  (:predicates (asked ?a - agent))
  (:functions (mood ?a - agent))
  ;; HRCPLAN: range mood 0 10
  (:action ask :parameters (?a - agent) :effect (asked ?a)))
