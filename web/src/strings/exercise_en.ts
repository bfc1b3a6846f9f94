// SPDX-License-Identifier: Apache-2.0
// What the participant of an exercise is told, in English: on the patient's screen, and for the therapist, who shows or reads it.

export const en = {
  /// By the instruction of the exercise's file.
  goals: {
    "Keep the bar on the moving target.": "Press, and stay in the moving light",
    "Press until the bar is in the band, and hold it there.": "Press until you are in the light, and stay there",
    "Press quickly and strongly.": "Squeeze quickly, then let go",
    "Hold the ball without letting it slip.": "Hold the ball gently between thumb and finger",
    "Touch the fingertip with your thumb": "Touch this fingertip with your thumb",
    "Touch the fingertip with your thumb, and stay there": "Touch this fingertip with your thumb, and stay there",
    "Move only this finger": "Move only this finger",
    "Bend the finger to the target in one smooth movement": "Bend your finger in one smooth movement",
    "Press slowly until you are told to stop, then let go.": "Press slowly, until you see the sign",
    "Close your hand and feel the object.": "Close your hand. What do you feel?",
    "Press as strongly as is comfortable.": "Press as strongly as feels good",
    "Open your hand as far as you can, then close it as far as you can.": "Open your hand wide, then close it",
    "Open your hand as far as you can, then make a fist.": "Open your hand wide, then make a fist",
    "Open your hand, close it, and open it again.": "Open your hand, close it, and open it again",
  } as Readonly<Record<string, string>>,
  moves: {
    open: "Open your hand wide",
    close: "Close your hand",
    letGo: "Let go",
    hold: "Hold it there",
    straighten: (finger: string) => `Straighten only ${finger}`,
    bend: (finger: string) => `Bend only ${finger}`,
    touch: (finger: string) => `Touch ${finger} with your thumb`,
    with: (goal: string, finger: string) => `${goal}: ${finger}`,
  },
  fingers: ["your thumb", "your index finger", "your middle finger", "your ring finger", "your little finger"],
  choices: {
    "the first": "The first one", "the second": "The second one",
    "a ball": "A ball", "a cube": "A cube", "a cylinder": "A cylinder",
  } as Readonly<Record<string, string>>,
  warmUp: "Move your fingers gently",
  second: "Let go. The second one is next.",
  softer: "Which one was softer?",
  which: "What was in your hand?",
};

export type ExerciseStrings = typeof en;
