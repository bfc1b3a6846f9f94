// SPDX-License-Identifier: Apache-2.0
// What the participant of an exercise is told, in German. No native speaker has reviewed it.
import type { ExerciseStrings } from "./exercise_en";

export const de: ExerciseStrings = {
  goals: {
    "Keep the bar on the moving target.": "Drücken Sie, und folgen Sie dem Licht",
    "Press until the bar is in the band, and hold it there.": "Drücken Sie bis ins Licht, und bleiben Sie dort",
    "Press quickly and strongly.": "Drücken Sie schnell. Lassen Sie dann los",
    "Hold the ball without letting it slip.": "Halten Sie den Ball sanft zwischen Daumen und Finger",
    "Touch the fingertip with your thumb": "Tippen Sie mit dem Daumen an diese Fingerspitze",
    "Touch the fingertip with your thumb, and stay there": "Tippen Sie mit dem Daumen an diese Fingerspitze. Bleiben Sie dort",
    "Move only this finger": "Bewegen Sie nur diesen Finger",
    "Bend the finger to the target in one smooth movement": "Beugen Sie den Finger in einer fließenden Bewegung",
    "Press slowly until you are told to stop, then let go.": "Drücken Sie langsam, bis das Zeichen kommt",
    "Close your hand and feel the object.": "Schließen Sie die Hand. Was spüren Sie?",
    "Press as strongly as is comfortable.": "Drücken Sie so stark, wie es angenehm ist",
    "Open your hand as far as you can, then close it as far as you can.": "Öffnen Sie die Hand weit, und schließen Sie sie dann",
    "Open your hand as far as you can, then make a fist.": "Öffnen Sie die Hand weit, und machen Sie dann eine Faust",
    "Open your hand, close it, and open it again.": "Öffnen Sie die Hand, schließen Sie sie, und öffnen Sie sie wieder",
  },
  moves: {
    open: "Öffnen Sie die Hand weit",
    close: "Schließen Sie die Hand",
    letGo: "Lassen Sie los",
    hold: "Bleiben Sie genau so",
    straighten: (finger: string) => `Strecken Sie nur ${finger}`,
    bend: (finger: string) => `Beugen Sie nur ${finger}`,
    touch: (finger: string) => `Tippen Sie mit dem Daumen an ${finger}`,
    with: (goal: string, finger: string) => `${goal}: ${finger}`,
  },
  fingers: ["den Daumen", "den Zeigefinger", "den Mittelfinger", "den Ringfinger", "den kleinen Finger"],
  choices: {
    "the first": "Der erste", "the second": "Der zweite",
    "a ball": "Ein Ball", "a cube": "Ein Würfel", "a cylinder": "Ein Zylinder",
  },
  warmUp: "Bewegen Sie sanft die Finger",
  second: "Lassen Sie los. Gleich kommt der zweite.",
  softer: "Welcher war weicher?",
  which: "Was war in Ihrer Hand?",
};
