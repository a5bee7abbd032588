(define (problem chest)
  (:domain joinery)
  (:objects
    robot joiner - agent
    store booth bench rack - place
    seat legs lid - part
    red blue - colour)
  (:init
    (controllable robot)
    (way store booth) (way booth store)
    (way booth bench) (way bench booth)
    (way bench rack) (way rack bench)
    (way store bench) (way bench store)
    (sprays robot) (sprays joiner) (glues joiner)
    (lifts robot seat) (lifts robot legs) (lifts robot lid) (lifts joiner seat) (lifts joiner lid)
    (booth booth) (bench bench)
    (joint seat legs) (joint lid legs)
    (at joiner bench) (free joiner)
    (at robot rack) (free robot)
    (on seat store) (on legs store) (on lid rack)
    (raw seat) (raw legs) (raw lid)
    (= (total-cost) 0) (= (motivation joiner) 1) (= (motivation robot) 1))
  (:goal (and (glued lid legs)))
  (:metric minimize (total-cost)))
