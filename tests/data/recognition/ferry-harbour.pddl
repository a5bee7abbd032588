(define (problem harbour) (:domain ferry)
  (:objects north east south west - quay red blue green white black - car)
  (:init (ferry-at north) (empty) (at red north) (at blue east) (at green south) (at white west) (at black west))
  (:goal (at red south)))
