; Rovers drive to samples and views, and send what they have found from where the lander is in sight.
(define (domain rovers)
  (:requirements :strips :typing)
  (:types rover site sample)
  (:predicates (at ?r - rover ?s - site) (way ?r - rover ?a ?b - site) (lies ?x - sample ?s - site)
    (empty ?r - rover) (carries ?r - rover ?x - sample) (analysed ?r - rover ?x - sample)
    (in-sight ?s - site) (sent ?x - sample) (photographed ?r - rover ?s - site) (shown ?s - site)
    (has-camera ?r - rover))
  (:action drive
    :parameters (?r - rover ?a ?b - site) :precondition (and (at ?r ?a) (way ?r ?a ?b))
    :effect (and (at ?r ?b) (not (at ?r ?a))))
  (:action collect
    :parameters (?r - rover ?x - sample ?s - site) :precondition (and (at ?r ?s) (lies ?x ?s) (empty ?r))
    :effect (and (carries ?r ?x) (not (lies ?x ?s)) (not (empty ?r))))
  (:action analyse
    :parameters (?r - rover ?x - sample) :precondition (carries ?r ?x) :effect (analysed ?r ?x))
  (:action empty-drum
    :parameters (?r - rover ?x - sample) :precondition (carries ?r ?x)
    :effect (and (empty ?r) (not (carries ?r ?x))))
  (:action photograph
    :parameters (?r - rover ?s - site) :precondition (and (at ?r ?s) (has-camera ?r))
    :effect (photographed ?r ?s))
  (:action send-analysis
    :parameters (?r - rover ?x - sample ?s - site)
    :precondition (and (at ?r ?s) (in-sight ?s) (analysed ?r ?x)) :effect (sent ?x))
  (:action send-photograph
    :parameters (?r - rover ?v ?s - site)
    :precondition (and (at ?r ?s) (in-sight ?s) (photographed ?r ?v)) :effect (shown ?v)))
