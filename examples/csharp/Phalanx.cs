// SPDX-License-Identifier: Apache-2.0
//
// Phalanx for C#, in one file: the C interface phalanx.h through P/Invoke. Copy it into your project; it needs no
// unsafe code and no package. It was tested with Mono 6.8 on Linux. It is also meant for Unity's editor and player
// on Linux, but was not run in Unity: neither Unity nor IL2CPP was available. There is no Phalanx for Windows or
// macOS.
//
// The library libphalanx.so.0 must be found: install the package, or set LD_LIBRARY_PATH. In Unity, put it into
// Assets/Plugins/x86_64 under the name libphalanx.so, and change Native.Library to "phalanx".
//
// Units are SI and radians; docs/c-api.md and phalanx.h describe every number. Phalanx' frames are right-handed.
// Unity's are left-handed: negate z of points and forces, and x and y of quaternions.
//
// A State is used by one thread at a time; State.Set() by any. Step() and Read() make no garbage.
using System;
using System.Runtime.InteropServices;
using System.Text;

namespace Phalanx
{
    /// <summary>A call that failed, with the words of the library.</summary>
    public sealed class PhalanxException : Exception
    {
        public readonly int Result;  // PHALANX_ERROR_*

        public PhalanxException(int result, string text) : base(text) { Result = result; }
    }

    /// <summary>Bits of Snapshot.Status.</summary>
    [Flags]
    public enum Status : uint
    {
        Ok = 0,
        SampleNotFinite = 1 << 0,
        SampleOutOfRange = 1 << 1,
        SampleJump = 1 << 2,
        TimeNotIncreasing = 1 << 3,
        StartInside = 1 << 4,
        Slid = 1 << 5,
        SearchExhausted = 1 << 6,
        ForceLimited = 1 << 7,
        TorqueLimited = 1 << 8,
        TorqueRateLimited = 1 << 9,
        CommandNotFinite = 1 << 10,
        TrajectoryExhausted = 1 << 11,
        SampleStale = 1 << 12,
        Oscillating = 1 << 13
    }

    /// <summary>Meshes of a model.</summary>
    public enum MeshKind { Segment = 0, Display = 1, Objects = 2 }

    public sealed class SceneHandle : SafeHandle
    {
        public SceneHandle() : base(IntPtr.Zero, true) { }
        public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
        protected override bool ReleaseHandle() { return Native.phalanx_scene_destroy(handle) == 0; }
    }

    public sealed class ModelHandle : SafeHandle
    {
        public ModelHandle() : base(IntPtr.Zero, true) { }
        public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
        protected override bool ReleaseHandle() { return Native.phalanx_model_destroy(handle) == 0; }
    }

    public sealed class MotionHandle : SafeHandle
    {
        public MotionHandle() : base(IntPtr.Zero, true) { }
        public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
        protected override bool ReleaseHandle() { return Native.phalanx_motion_destroy(handle) == 0; }
    }

    public sealed class StateHandle : SafeHandle
    {
        public StateHandle() : base(IntPtr.Zero, true) { }
        public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
        protected override bool ReleaseHandle() { return Native.phalanx_state_destroy(handle) == 0; }
    }

    public sealed class RecorderHandle : SafeHandle
    {
        public RecorderHandle() : base(IntPtr.Zero, true) { }
        public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
        protected override bool ReleaseHandle() { return Native.phalanx_recorder_destroy(handle) == 0; }
    }

    static class Native
    {
        const string Library = "libphalanx.so.0";

        [StructLayout(LayoutKind.Sequential)]
        internal struct Mesh
        {
            public uint StructSize;
            public uint Reserved;
            public ulong VertexCount;
            public ulong TriangleCount;
            public IntPtr Vertices;
            public IntPtr Triangles;
        }

        [DllImport(Library)] internal static extern IntPtr phalanx_version();
        [DllImport(Library)] internal static extern IntPtr phalanx_error_text();
        [DllImport(Library)] internal static extern int phalanx_scene_load(byte[] name, out SceneHandle scene);
        [DllImport(Library)] internal static extern int phalanx_scene_parse(byte[] text, byte[] folder, out SceneHandle scene);
        [DllImport(Library)] internal static extern int phalanx_scene_set(SceneHandle scene, byte[] key, byte[] value);
        [DllImport(Library)] internal static extern int phalanx_scene_get(SceneHandle scene, byte[] key, byte[] text, UIntPtr size, out UIntPtr needed);
        [DllImport(Library)] internal static extern int phalanx_scene_destroy(IntPtr scene);
        [DllImport(Library)] internal static extern int phalanx_model_create(SceneHandle scene, out ModelHandle model);
        [DllImport(Library)] internal static extern int phalanx_model_create_from_mesh(IntPtr hand, double[] vertices, UIntPtr vertexCount, int[] triangles, UIntPtr triangleCount, out ModelHandle model);
        [DllImport(Library)] internal static extern int phalanx_model_get_mesh(ModelHandle model, int kind, int segment, ref Mesh mesh);
        [DllImport(Library)] internal static extern int phalanx_model_destroy(IntPtr model);
        [DllImport(Library)] internal static extern int phalanx_motion_create(SceneHandle scene, out MotionHandle motion);
        [DllImport(Library)] internal static extern int phalanx_motion_get_seconds(MotionHandle motion, out double seconds);
        [DllImport(Library)] internal static extern int phalanx_motion_get_sample(MotionHandle motion, double time, IntPtr sample);
        [DllImport(Library)] internal static extern int phalanx_motion_destroy(IntPtr motion);
        [DllImport(Library)] internal static extern int phalanx_state_create(ModelHandle model, SceneHandle scene, out StateHandle state);
        [DllImport(Library)] internal static extern int phalanx_step(StateHandle state, IntPtr sample, out uint status);
        [DllImport(Library)] internal static extern int phalanx_state_set(StateHandle state, byte[] key, byte[] value);
        [DllImport(Library)] internal static extern int phalanx_state_get(StateHandle state, byte[] key, byte[] text, UIntPtr size, out UIntPtr needed);
        [DllImport(Library)] internal static extern int phalanx_state_get_rate(StateHandle state, out double rate);
        [DllImport(Library)] internal static extern int phalanx_state_confirm_opening(StateHandle state, int digit);
        [DllImport(Library)] internal static extern int phalanx_state_withdraw_openings(StateHandle state);
        [DllImport(Library)] internal static extern int phalanx_state_get_snapshot(StateHandle state, IntPtr snapshot);
        [DllImport(Library)] internal static extern int phalanx_state_destroy(IntPtr state);
        [DllImport(Library)] internal static extern int phalanx_recorder_create(StateHandle state, byte[] path, out RecorderHandle recorder);
        [DllImport(Library)] internal static extern int phalanx_recorder_add(RecorderHandle recorder);
        [DllImport(Library)] internal static extern int phalanx_recorder_event(RecorderHandle recorder, byte[] code, byte[] text);
        [DllImport(Library)] internal static extern int phalanx_recorder_finish(RecorderHandle recorder);
        [DllImport(Library)] internal static extern int phalanx_recorder_destroy(IntPtr recorder);

        /// Throws the library's words if a call failed.
        internal static void Check(int result)
        {
            if (result != 0) throw new PhalanxException(result, Text(phalanx_error_text()));
        }

        internal static string Text(IntPtr utf8)
        {
            int length = 0;
            while (Marshal.ReadByte(utf8, length) != 0) ++length;
            byte[] bytes = new byte[length];
            Marshal.Copy(utf8, bytes, 0, length);
            return Encoding.UTF8.GetString(bytes);
        }

        /// The bytes of a text, with the zero at its end.
        internal static byte[] Utf8(string text)
        {
            if (text.IndexOf('\0') >= 0) throw new ArgumentException("the text holds a zero character");
            return Encoding.UTF8.GetBytes(text + "\0");
        }

        internal static string Text(byte[] withZero)
        {
            return Encoding.UTF8.GetString(withZero, 0, withZero.Length - 1);
        }
    }

    /// <summary>The library.</summary>
    public static class Library
    {
        public static string Version { get { return Native.Text(Native.phalanx_version()); } }
    }

    /// <summary>Hand, objects, parameters and motion, as a scene file states them.</summary>
    public sealed class Scene : IDisposable
    {
        internal readonly SceneHandle Handle;

        Scene(SceneHandle handle) { Handle = handle; }

        /// <summary>Reads a shipped scene by its name, or a file by its path.</summary>
        public static Scene Load(string name)
        {
            SceneHandle handle;
            Native.Check(Native.phalanx_scene_load(Native.Utf8(name), out handle));
            return new Scene(handle);
        }

        /// <summary>Reads TOML text. folder: of its relative paths; null: the working directory.</summary>
        public static Scene Parse(string text, string folder = null)
        {
            SceneHandle handle;
            Native.Check(Native.phalanx_scene_parse(Native.Utf8(text), folder == null ? null : Native.Utf8(folder), out handle));
            return new Scene(handle);
        }

        public void Set(string key, string value)
        {
            Native.Check(Native.phalanx_scene_set(Handle, Native.Utf8(key), Native.Utf8(value)));
        }

        public string Get(string key)
        {
            UIntPtr size;
            byte[] name = Native.Utf8(key);
            Native.Check(Native.phalanx_scene_get(Handle, name, null, UIntPtr.Zero, out size));
            byte[] text = new byte[(int)size];
            Native.Check(Native.phalanx_scene_get(Handle, name, text, size, out size));
            return Native.Text(text);
        }

        public void Dispose() { Handle.Dispose(); }
    }

    /// <summary>Triangle mesh: x, y, z of each vertex [m], and three indices of each triangle.</summary>
    public sealed class Mesh
    {
        public double[] Vertices;
        public int[] Triangles;
    }

    /// <summary>Hand and objects. Constant; any number of threads and states may use one.</summary>
    public sealed class Model : IDisposable
    {
        internal readonly ModelHandle Handle;

        /// <summary>Makes the model of a scene.</summary>
        public Model(Scene scene) { Native.Check(Native.phalanx_model_create(scene.Handle, out Handle)); }

        /// <summary>Makes a model from arrays, with the hand of round numbers, 180 mm long, at the world's origin.</summary>
        public Model(Mesh objects)
        {
            Native.Check(Native.phalanx_model_create_from_mesh(IntPtr.Zero, objects.Vertices, (UIntPtr)(objects.Vertices.Length / 3), objects.Triangles,
                                                               (UIntPtr)(objects.Triangles.Length / 3), out Handle));
        }

        /// <summary>Copies a mesh. A segment's is in its own frame: Snapshot.ShownPosition and ShownRotation place it.</summary>
        public Mesh GetMesh(MeshKind kind, int segment = 0)
        {
            Native.Mesh mesh = new Native.Mesh { StructSize = (uint)Marshal.SizeOf(typeof(Native.Mesh)) };
            Native.Check(Native.phalanx_model_get_mesh(Handle, (int)kind, segment, ref mesh));
            Mesh copy = new Mesh { Vertices = new double[3 * mesh.VertexCount], Triangles = new int[3 * mesh.TriangleCount] };
            if (copy.Vertices.Length > 0) Marshal.Copy(mesh.Vertices, copy.Vertices, 0, copy.Vertices.Length);
            if (copy.Triangles.Length > 0) Marshal.Copy(mesh.Triangles, copy.Triangles, 0, copy.Triangles.Length);
            GC.KeepAlive(this); // the model's finalizer frees the mesh
            return copy;
        }

        public void Dispose() { Handle.Dispose(); }
    }

    /// <summary>Measurement at one tick. Its memory is reused from step to step.</summary>
    public sealed class Sample : IDisposable
    {
        const int Words = 50;  // of 8 bytes
        private IntPtr owned = Marshal.AllocHGlobal(8 * Words);
        internal IntPtr Memory
        {
            get
            {
                if (owned == IntPtr.Zero) throw new ObjectDisposedException("Sample");
                return owned;
            }
        }
        readonly double[] time = new double[1];

        /// <summary>20 joint angles [rad]: 4 for each digit from the thumb: flexion, abduction, two hinges.</summary>
        public readonly double[] Angle = new double[20];

        public Sample()
        {
            Marshal.Copy(new double[Words], 0, Memory, Words);
            Marshal.WriteInt32(Memory, 8 * Words);
        }

        /// <summary>Strictly increasing [s].</summary>
        public double Time
        {
            get { return time[0]; }
            set { time[0] = value; }
        }

        internal void Write()
        {
            Marshal.Copy(time, 0, IntPtr.Add(Memory, 8), 1);
            Marshal.Copy(Angle, 0, IntPtr.Add(Memory, 16), 20);
        }

        internal void Read()
        {
            Marshal.Copy(IntPtr.Add(Memory, 8), time, 0, 1);
            Marshal.Copy(IntPtr.Add(Memory, 16), Angle, 0, 20);
        }

        public void Dispose()
        {
            Marshal.FreeHGlobal(owned);
            owned = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Sample() { Marshal.FreeHGlobal(owned); }
    }

    /// <summary>Motion of the whole hand over time.</summary>
    public sealed class Motion : IDisposable
    {
        internal readonly MotionHandle Handle;
        public readonly double Seconds;

        public Motion(Scene scene)
        {
            Native.Check(Native.phalanx_motion_create(scene.Handle, out Handle));
            Native.Check(Native.phalanx_motion_get_seconds(Handle, out Seconds));
        }

        /// <summary>Writes time and angles, and the origin of each angle.</summary>
        public void GetSample(double time, Sample sample)
        {
            Native.Check(Native.phalanx_motion_get_sample(Handle, time, sample.Memory));
            sample.Read();
            GC.KeepAlive(sample);
        }

        public void Dispose() { Handle.Dispose(); }
    }

    /// <summary>Result of a step. Its memory is reused: Read() replaces all values.</summary>
    public sealed class Snapshot : IDisposable
    {
        // Offsets in words of 8 bytes: phalanx_snapshot in phalanx.h.
        const int Words = 972, TorqueAt = 3, MeasuredAt = 23, ShownAt = 43, DigitForceAt = 63, FingertipAt = 78;
        const int SegmentAt = 93, SegmentWords = 19, ShownPoseAt = 589, PoseWords = 12, StiffnessAt = 824;

        private IntPtr owned = Marshal.AllocHGlobal(8 * Words);
        internal IntPtr Memory
        {
            get
            {
                if (owned == IntPtr.Zero) throw new ObjectDisposedException("Snapshot");
                return owned;
            }
        }
        readonly double[] word = new double[Words];

        public Snapshot()
        {
            Marshal.Copy(word, 0, Memory, Words);
            Marshal.WriteInt32(Memory, 8 * Words);
        }

        internal void Read() { Marshal.Copy(Memory, word, 0, Words); }

        public Status Status { get { return (Status)Int32At(4); } }
        public long Tick
        {
            get
            {
                long tick = Marshal.ReadInt64(Memory, 8);
                GC.KeepAlive(this); // its finalizer frees the memory
                return tick;
            }
        }
        public double Time { get { return word[2]; } }
        /// <summary>Limited command on a joint of the finger [Nm].</summary>
        public double Torque(int joint) { return word[TorqueAt + Below(joint, 20)]; }
        public double MeasuredAngle(int joint) { return word[MeasuredAt + Below(joint, 20)]; }
        public double ShownAngle(int joint) { return word[ShownAt + Below(joint, 20)]; }
        /// <summary>Vector sum of a digit's forces on the finger, axis 0 .. 2 [N].</summary>
        public double DigitForce(int digit, int axis) { return word[DigitForceAt + 3 * Below(digit, 5) + Below(axis, 3)]; }
        /// <summary>Middle of a shown digit's pad, axis 0 .. 2 [m].</summary>
        public double Fingertip(int digit, int axis) { return word[FingertipAt + 3 * Below(digit, 5) + Below(axis, 3)]; }
        public bool Contact(int segment) { return Int32At(8 * (SegmentAt + SegmentWords * Below(segment, 16))) != 0; }
        public double Depth(int segment) { return Segment(segment, 2); }
        /// <summary>Magnitude of a segment's force [N].</summary>
        public double Force(int segment) { return Segment(segment, 4); }
        /// <summary>Contact point on the shown segment, axis 0 .. 2 [m].</summary>
        public double Point(int segment, int axis) { return Segment(segment, 5 + Below(axis, 3)); }
        /// <summary>Direction of the force on the finger, axis 0 .. 2.</summary>
        public double Normal(int segment, int axis) { return Segment(segment, 8 + Below(axis, 3)); }
        /// <summary>Rotation of a shown segment in the world, row and column 0 .. 2.</summary>
        public double ShownRotation(int segment, int row, int column)
        {
            return word[ShownPoseAt + PoseWords * Below(segment, 16) + 3 * Below(row, 3) + Below(column, 3)];
        }
        /// <summary>Position of a shown segment's joint in the world, axis 0 .. 2 [m].</summary>
        public double ShownPosition(int segment, int axis) { return word[ShownPoseAt + PoseWords * Below(segment, 16) + 9 + Below(axis, 3)]; }
        /// <summary>Stiffness of the force law at this step [N/m].</summary>
        public double Stiffness { get { return word[StiffnessAt]; } }

        /// <summary>Adds the bytes of all values but the struct's size to a hash, FNV-1a with 64 bits.</summary>
        public ulong Hash(ulong hash)
        {
            for (int i = 4; i < 8 * Words; ++i) hash = unchecked((hash ^ Marshal.ReadByte(Memory, i)) * 0x100000001b3UL);
            GC.KeepAlive(this);
            return hash;
        }

        int Int32At(int offset)
        {
            int value = Marshal.ReadInt32(Memory, offset);
            GC.KeepAlive(this); // its finalizer frees the memory
            return value;
        }

        double Segment(int segment, int at) { return word[SegmentAt + SegmentWords * Below(segment, 16) + at]; }

        static int Below(int index, int count)
        {
            if (index < 0 || index >= count) throw new ArgumentOutOfRangeException();
            return index;
        }

        public void Dispose()
        {
            Marshal.FreeHGlobal(owned);
            owned = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Snapshot() { Marshal.FreeHGlobal(owned); }
    }

    /// <summary>State that one step leaves for the next, with its parameters.</summary>
    public sealed class State : IDisposable
    {
        internal readonly StateHandle Handle;
        /// <summary>Nominal rate of Step() [Hz].</summary>
        public readonly double Rate;

        /// <summary>Begins at the open hand. scene: with the parameters; null: the default of each.</summary>
        public State(Model model, Scene scene = null)
        {
            SceneHandle parameters = scene == null ? new SceneHandle() : scene.Handle;
            Native.Check(Native.phalanx_state_create(model.Handle, parameters, out Handle));
            Native.Check(Native.phalanx_state_get_rate(Handle, out Rate));
        }

        /// <summary>Makes one tick of the whole hand.</summary>
        public Status Step(Sample sample)
        {
            uint status;
            sample.Write();
            Native.Check(Native.phalanx_step(Handle, sample.Memory, out status));
            GC.KeepAlive(sample); // its finalizer frees the memory
            return (Status)status;
        }

        /// <summary>Reads the result of the last step.</summary>
        public void Read(Snapshot into)
        {
            Native.Check(Native.phalanx_state_get_snapshot(Handle, into.Memory));
            into.Read();
            GC.KeepAlive(into);
        }

        /// <summary>Replaces a parameter that changes in contact, over 0.2 s. Any thread.</summary>
        public void Set(string key, string value)
        {
            Native.Check(Native.phalanx_state_set(Handle, Native.Utf8(key), Native.Utf8(value)));
        }

        /// <summary>Opens a digit that started inside an object, after a person has confirmed it.</summary>
        public void ConfirmOpening(int digit) { Native.Check(Native.phalanx_state_confirm_opening(Handle, digit)); }

        public void WithdrawOpenings() { Native.Check(Native.phalanx_state_withdraw_openings(Handle)); }

        public void Dispose() { Handle.Dispose(); }
    }

    /// <summary>Recording of a state that has made no step. Dispose it before the state.</summary>
    public sealed class Recorder : IDisposable
    {
        readonly RecorderHandle handle;

        public Recorder(State state, string path) { Native.Check(Native.phalanx_recorder_create(state.Handle, Native.Utf8(path), out handle)); }

        /// <summary>Adds the last step; it may wait for the disk.</summary>
        public void Add() { Native.Check(Native.phalanx_recorder_add(handle)); }

        public void Event(string code, string text) { Native.Check(Native.phalanx_recorder_event(handle, Native.Utf8(code), Native.Utf8(text))); }

        /// <summary>Writes the rest and the file's end.</summary>
        public void Finish() { Native.Check(Native.phalanx_recorder_finish(handle)); }

        public void Dispose() { handle.Dispose(); }
    }
}
