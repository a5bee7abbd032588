(define (domain d)
  (:types
    animal - pet  ;; expect: cyclic-types
    pet - thing
    thing - animal
    dog - pet
    self - self)  ;; expect: cyclic-types
  (:predicates (fed ?d - dog))
  (:action feed :parameters (?d - dog) :effect (fed ?d)))
