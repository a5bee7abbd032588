(define (problem orbit) (:domain telescope)
  (:objects sat1 sat2 - satellite i1 i2 i3 - instrument colour heat - mode
    star moon sun venus mars - direction)
  (:init (on-board i1 sat1) (on-board i2 sat1) (on-board i3 sat2) (supports i1 colour) (supports i2 heat)
    (supports i3 heat) (supports i3 colour) (target i1 star) (target i2 moon) (target i3 sun)
    (points sat1 venus) (points sat2 mars) (has-power sat1) (has-power sat2))
  (:goal (image star colour)))
