// SPDX-License-Identifier: Apache-2.0
// The faults of the station in German, by name: meaning and remedy. In English the page shows the station's own words.
export const de: Readonly<Record<string, string>> = {
  step_too_old: "Der neueste Schritt, den die Steuerung hatte, war 20 ms alt; sie hat das Drehmoment abgeschaltet. Prüfen Sie die Verbindung und ob der Rechner ausgelastet ist.",
  sensor_range: "Ein Sensor liefert Werte außerhalb seines Bereichs: Die Leitung ist unterbrochen oder kurzgeschlossen. Prüfen Sie Stecker und Leitung.",
  emergency_stop: "Der Not-Halt wurde gedrückt. Klären Sie den Grund und lösen Sie den Knopf.",
  drive: "Die Elektronik des Geräts meldet eine Störung: Motortreiber, Versorgung oder Temperatur. Sehen Sie auf der Anzeige des Geräts nach.",
  no_sample: "Seit 10 ms kommen keine Messwerte vom Gerät. Prüfen Sie Kabel und Stromversorgung und ob ein anderes Programm den Rechner auslastet.",
  controller_restarted: "Die Steuerung wurde aus- und wieder eingeschaltet. Prüfen Sie ihre Stromversorgung.",
  refused: "Das Gerät hat die Verbindung abgelehnt: Ein anderes Programm benutzt es, oder seine Version passt nicht. Beenden Sie das andere Programm, oder bringen Sie beide auf eine Version.",
  sample_not_finite: "Ein Winkel war in 3 Messwerten nacheinander keine Zahl. Prüfen Sie Kalibrierung und Sensor.",
  out_of_range: "Ein Gelenk war weit außerhalb des Bewegungsbereichs. Prüfen Sie, wie das Gerät sitzt; kalibrieren Sie bei Bedarf neu.",
  jump: "Ein Gelenk bewegte sich schneller, als eine Hand es kann. Prüfen Sie den Sensor des Gelenks und seine Leitung.",
  clock_backwards: "Die Uhr des Geräts ging nicht vorwärts. Starten Sie das Gerät neu; geschieht es wieder, ist seine Firmware fehlerhaft.",
  stuck_sensor: "Ein Sensor stand still, obwohl sich sein Gelenk bewegt hat. Prüfen Sie, ob sich seine Achse mit dem Gelenk dreht.",
  torque_disagrees: "Gemessenes und befohlenes Drehmoment stimmen nicht überein. Prüfen Sie Motor, Seilzug und Kalibrierung des Sensors.",
  overload: "Zu viele Schritte nacheinander endeten zu spät. Entlasten Sie den Rechner, oder wählen Sie eine einfachere Szene.",
  force_ceiling: "Ein Schritt verlangte mehr Kraft an einem Finger, als erlaubt ist. Prüfen Sie Steifigkeit und Kraftgrenzen.",
  command_not_finite: "Der Befehl eines Schritts war keine endliche Zahl. Bewahren Sie den Störungsbericht auf, und melden Sie den Fehler.",
  device_lost: "Der Anschluss des Geräts ist ausgefallen. Stecken Sie das Gerät wieder ein.",
  not_acting: "Das Gerät führt die Befehle nicht aus. Prüfen Sie, ob es das richtige Gerät ist und ob seine Firmware passt.",
  oscillation: "Die Kraft hat bald nach ihrer Rückkehr wieder geschwungen. Verringern Sie die Steifigkeit.",
  sample_rate: "Das Gerät sendet weniger als halb oder mehr als doppelt so viele Messwerte, wie es zusagt. Korrigieren Sie die Rate in seiner Firmware oder seine Uhr, und prüfen Sie, ob sein Prozessor überlastet ist.",
};
