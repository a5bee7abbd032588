;; A workshop in German: names of actions and objects are words of another language than English.
(define (domain werkstatt)
  (:requirements :strips :typing)
  (:types agent teil werkzeug - object)
  (:predicates
    (im-lager ?x - object) (bereit ?x - object) (gebohrt ?t - teil) (geschliffen ?t - teil)
    (verschraubt ?t ?u - teil) (gestrichen ?t - teil) (bohrt ?w - werkzeug) (streicht ?w - werkzeug))

  (:action holen
    :parameters (?a - agent ?x - object)
    :precondition (im-lager ?x)
    :effect (and (bereit ?x) (not (im-lager ?x))))

  (:action bohren
    :parameters (?a - agent ?t - teil ?w - werkzeug)
    :precondition (and (bereit ?t) (bereit ?w) (bohrt ?w))
    :effect (gebohrt ?t))

  (:action schleifen
    :parameters (?a - agent ?t - teil)
    :precondition (bereit ?t)
    :effect (geschliffen ?t))

  (:action verschrauben
    :parameters (?a - agent ?t ?u - teil)
    :precondition (and (gebohrt ?t) (gebohrt ?u))
    :effect (verschraubt ?t ?u))

  (:action streichen
    :parameters (?a - agent ?t - teil ?w - werkzeug)
    :precondition (and (geschliffen ?t) (bereit ?w) (streicht ?w))
    :effect (gestrichen ?t)))
