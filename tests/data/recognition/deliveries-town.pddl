(define (problem town) (:domain deliveries)
  (:objects ann bob - driver van lorry - truck p1 p2 p3 p4 - parcel
    depot mill market school station - place)
  (:init (at ann depot) (at bob station) (at van depot) (at lorry market) (unmanned van) (unmanned lorry)
    (at p1 depot) (at p2 mill) (at p3 market) (at p4 school)
    (road depot mill) (road mill depot) (road mill market) (road market mill) (road market school)
    (road school market) (road school station) (road station school) (road station depot) (road depot station)
    (path station market) (path market station) (path depot mill) (path mill depot))
  (:goal (at p1 school)))
