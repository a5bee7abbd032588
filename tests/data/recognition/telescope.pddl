; Satellites turn, switch instruments on, calibrate them, and take images.
(define (domain telescope)
  (:requirements :strips :typing)
  (:types satellite direction instrument mode)
  (:predicates (on-board ?i - instrument ?s - satellite) (supports ?i - instrument ?m - mode)
    (points ?s - satellite ?d - direction) (has-power ?s - satellite) (is-on ?i - instrument)
    (calibrated ?i - instrument) (image ?d - direction ?m - mode) (target ?i - instrument ?d - direction))
  (:action turn
    :parameters (?s - satellite ?new ?old - direction) :precondition (points ?s ?old)
    :effect (and (points ?s ?new) (not (points ?s ?old))))
  (:action switch-on
    :parameters (?i - instrument ?s - satellite) :precondition (and (on-board ?i ?s) (has-power ?s))
    :effect (and (is-on ?i) (not (calibrated ?i)) (not (has-power ?s))))
  (:action switch-off
    :parameters (?i - instrument ?s - satellite) :precondition (and (on-board ?i ?s) (is-on ?i))
    :effect (and (has-power ?s) (not (is-on ?i))))
  (:action calibrate
    :parameters (?s - satellite ?i - instrument ?d - direction)
    :precondition (and (on-board ?i ?s) (target ?i ?d) (points ?s ?d) (is-on ?i))
    :effect (calibrated ?i))
  (:action take-image
    :parameters (?s - satellite ?d - direction ?i - instrument ?m - mode)
    :precondition (and (calibrated ?i) (on-board ?i ?s) (supports ?i ?m) (is-on ?i) (points ?s ?d))
    :effect (image ?d ?m)))
