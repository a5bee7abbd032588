(define (problem hocker)
  (:domain werkstatt)
  (:objects
    mensch roboter - agent
    sitzfläche tischbein lehne - teil
    bohrmaschine pinsel - werkzeug)
  (:init
    (bohrt bohrmaschine) (streicht pinsel)
    (im-lager sitzfläche) (im-lager tischbein) (im-lager lehne)
    (im-lager bohrmaschine) (im-lager pinsel))
  (:goal (and (verschraubt sitzfläche tischbein) (gestrichen lehne))))
