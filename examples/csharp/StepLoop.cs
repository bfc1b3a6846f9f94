// SPDX-License-Identifier: Apache-2.0
// StepLoop [SCENE]: plays the motion of a scene through the step, as examples/c/step_loop.c does.
//   mcs Phalanx.cs StepLoop.cs -out:StepLoop.exe && mono StepLoop.exe
using System;
using Phalanx;

static class StepLoop
{
    // FNV-1a with 64 bits, over the bytes of a number.
    static ulong Add(ulong hash, double number)
    {
        ulong bits = (ulong)BitConverter.DoubleToInt64Bits(number);
        for (int i = 0; i < 8; ++i, bits >>= 8) hash = unchecked((hash ^ (bits & 0xff)) * 0x100000001b3UL);
        return hash;
    }

    static int Main(string[] arguments)
    {
        try
        {
            using (Scene scene = Scene.Load(arguments.Length > 0 ? arguments[0] : "press_teapot"))
            using (Model model = new Model(scene))
            using (Motion motion = new Motion(scene))
            using (State state = new State(model, scene))
            using (Sample sample = new Sample())
            using (Snapshot now = new Snapshot())
            {
                ulong forces = 0xcbf29ce484222325UL, all = forces;
                long steps = (long)(motion.Seconds * state.Rate + 0.5);
                for (long i = 0; i < steps; ++i)
                {
                    motion.GetSample(i / state.Rate, sample);  // a device measures this
                    state.Step(sample);
                    state.Read(now);  // now.Torque(joint) goes to the motors
                    for (int joint = 0; joint < 20; ++joint) forces = Add(forces, now.Torque(joint));
                    for (int s = 0; s < 16; ++s)
                    {
                        forces = Add(forces, now.Force(s));
                        for (int axis = 0; axis < 3; ++axis) forces = Add(forces, now.Point(s, axis));
                        for (int axis = 0; axis < 3; ++axis) forces = Add(forces, now.Normal(s, axis));
                    }
                    all = now.Hash(all);
                }
                Console.WriteLine("{0} steps, forces {1:x16}, snapshots {2:x16}", steps, forces, all);
            }
            return 0;
        }
        catch (PhalanxException error)
        {
            Console.Error.WriteLine("StepLoop: " + error.Message);
            return 1;
        }
    }
}
