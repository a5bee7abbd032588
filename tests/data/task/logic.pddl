;; Conditions of every shape: negation, disjunction, implication, quantifiers, equality, constants,
;; either types, a subtype, and static functions in conditions.
(define (domain logic)
  (:requirements :adl :typing :numeric-fluents)
  (:types thing key - object lamp door - thing big-key - key)
  (:constants master - big-key hall - lamp)
  (:predicates (on ?x - thing) (open ?d - door) (fits ?k - key ?d - door)
    (held ?k - key) (linked ?x ?y - thing) (alarm))
  (:functions (weight ?k - key) (limit))
  (:action switch
    :parameters (?l - lamp)
    :precondition (or (not (on ?l)) (exists (?d - door) (and (open ?d) (linked ?l ?d))))
    :effect (on ?l))
  (:action darken
    :parameters (?l - lamp)
    :precondition (and (on ?l) (not (= ?l hall)) (imply (alarm) (on hall)))
    :effect (not (on ?l)))
  (:action unlock
    :parameters (?d - door ?k - key)
    :precondition (and (held ?k) (or (fits ?k ?d) (= ?k master)) (not (open ?d))
      (<= (weight ?k) (limit)))
    :effect (and (open ?d) (not (held ?k))))
  (:action take-key
    :parameters (?k - big-key)
    :precondition (and (forall (?d - door) (not (and (open ?d) (on ?d)))) (not (held ?k)))
    :effect (held ?k))
  (:action take-small
    :parameters (?k - key)
    :precondition (and (not (held ?k)) (not (= ?k master)) (forall (?l - lamp) (imply (linked ?l ?l) (on ?l))))
    :effect (held ?k))
  (:action mark
    :parameters (?x - (either lamp door))
    :precondition (and (not (on ?x)) (not (exists (?y - thing) (and (linked ?x ?y) (on ?y)))))
    :effect (on ?x))
  (:action ring
    :parameters ()
    :precondition (not (alarm))
    :effect (alarm))
  (:action silence
    :parameters ()
    :precondition (and (alarm) (forall (?d - door) (or (open ?d) (on ?d))))
    :effect (not (alarm))))
