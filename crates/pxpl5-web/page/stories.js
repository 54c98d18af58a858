// The stories. A story is an experiment that runs in steps. Each step stops at an interesting instant, and two sentences explain it.

/** A path that turns the head to the left and right by some degrees, with a period in seconds. A path gives degrees to the left and
 *  upwards, and centimetres to the right. */
const swing = (degrees, period) => (seconds) => [degrees * Math.sin((2 * Math.PI * seconds) / period), 0];
const rest = () => [0, 0];
/** A path of a head that steps to the right by some centimetres, in some seconds, and then stands. */
const step = (cm, takes) => (seconds) => {
  const part = Math.min(1, seconds / takes);
  return [0, 0, cm * part * part * (3 - 2 * part)];
};

const HEAD = { "head.motion": "live.csv", "head.tracker": "fastrak", "head.predict": "none" };
const MS = 1e9;

/**
 * Each step has a `title` and two sentences (`say`). The step runs for `ms` of simulated time, `slower` times slower than the
 * machine. With `until`, the step ends at an event, after at most `ms`. The step can then run for `then` more milliseconds,
 * `thenSlower` times slower than the machine. At the end of the step, the page shows the sentence `paused`. `show` names the parts
 * of the page that are visible besides the pictures; `alone` hides the second machine, and `hand` invites to drag. A step without a
 * `path` continues the path of the previous step. With `hand`, the visitor moves the head, and the step does not end by itself. `keep`
 * returns the number that a visitor should remember, from the last data of the machines.
 */
export const STORIES = {
  lag: {
    name: "Feel the lag",
    settings: { pipeline: "rendering-control", scene: "gallery", triangles: "100", display: "ntsc", fields: "3600", ...HEAD },
    beside: "slats",
    eyes: 1,
    begin: 300,
    steps: [
      {
        title: "Your head, late",
        say: "Drag across a picture to turn the head, or use the arrow keys on it. The yellow wire frame is the world as it is now, and the picture behind it is what the machine shows in your headset.",
        path: swing(12, 4), ms: 600_000, show: ["wire", "age", "added", "hand"], hand: true,
        paused: "",
      },
      {
        title: "The head turns",
        say: "Now the head turns to the left and to the right by itself. The picture lags behind the wire frame, because the machine drew it for an earlier pose of the head.",
        path: swing(18, 2), ms: 1050, slower: 2, show: ["wire", "age"],
        paused: "The run has stopped in the middle of a turn. In a headset, this gap between world and picture makes the picture seem to swim.",
      },
      {
        title: "This is latency",
        say: "Latency is the time from the measurement of the head to the light of the picture. The number beside each name is the age of the picture: the older the picture, the wider the gap.",
        ms: 320, slower: 6, show: ["wire", "age"],
        paused: "Compare the two ages. The scene, the head and the boards are the same.",
      },
      {
        title: "Where the time goes",
        say: "Rendering Control draws one eye after the other, and each picture passes through several stages. A finished picture then waits for the next field of the screen, which begins every sixtieth of a second.",
        ms: 120, slower: 6, show: ["wire", "age", "latency"],
        paused: "Each coloured piece of a bar is a stage or a wait.",
      },
      {
        title: "How Slats is faster",
        say: "Slats keeps the whole screen in the drawing boards (renderers), so each triangle is drawn as soon as its position is known. All stages fit into one field, but only for scenes of about a hundred triangles.",
        ms: 320, slower: 6, show: ["wire", "age", "latency"],
        paused: "In the same turn, Slats has the smaller gap, because its picture is younger.",
      },
      {
        title: "Now you",
        say: "Turn the head again, and add latency with the slider. In the laboratory you can change the scene, the pipeline and the tracker of this experiment.",
        path: swing(12, 4), ms: 600_000, slower: 1, show: ["wire", "age", "added", "hand"], hand: true,
        paused: "",
        keep: () => "To keep: at 100 degrees a second, each 10 ms of latency are one degree, or 11 of the 640 pixels of this display.",
      },
    ],
  },
  inside: {
    name: "Inside the machine",
    settings: { pipeline: "rendering-control", scene: "gallery", display: "ntsc", fields: "3600", "head.motion": "sine:14:0.4", "head.tracker": "fastrak", "head.predict": "none" },
    eyes: 1,
    begin: 400,
    steps: [
      {
        title: "Boards on a ring",
        say: "The machine is a set of computer boards around a fast ring, over which the boards send messages. In this story, time runs up to 8,000 times slower, so you can follow the messages.",
        ms: 5, slower: 400, show: ["diagram", "regions"],
        paused: "Boards that wait are grey. Each board that works shows its stage.",
      },
      {
        title: "1. The pose of the head",
        say: "The host reads the tracker and sends the pose of the head (position and direction) to the graphics processors. From the measurement of this pose on, the picture grows older.",
        until: "pose", ms: 200, slower: 60, then: 0.06, thenSlower: 8000, show: ["diagram", "regions", "age"],
        paused: "The message of the host is on the ring.",
      },
      {
        title: "2. TRANSFORM",
        say: "Each graphics processor (GP) computes the positions of its triangles on the screen. The GP then sorts the triangles into bins, one for each region of 128 by 128 pixels.",
        until: "transform", ms: 200, slower: 60, show: ["diagram", "regions", "age"],
        paused: "The GPs work at the same time, and the first GPs already send commands. The renderers still copy the previous picture.",
      },
      {
        title: "3. RENDER",
        say: "A renderer has a small processor for each of its 16,384 pixels, and all of these processors execute the same command together. A dashed orange frame in the picture marks a region that a renderer draws now.",
        until: "draw", ms: 200, slower: 100, show: ["diagram", "regions", "age"],
        paused: "A renderer with both colours draws a new region while it still copies the pixels of the region before.",
      },
      {
        title: "4. COPY",
        say: "Finished regions go over the ring into the memory of the picture (the frame buffer), one at a time. A green frame marks the region that is copied now, while the renderers already draw other regions.",
        until: "copy", ms: 200, slower: 100, then: 1.5, thenSlower: 800, show: ["diagram", "regions", "age"],
        paused: "The screen still shows an older picture.",
      },
      {
        title: "5. Swap",
        say: "When all regions of both eyes have arrived, the screen changes to the new picture at the start of the next field. Every earlier stage has added to the age of the picture.",
        until: "swap", ms: 300, slower: 20, show: ["diagram", "regions", "age", "latency"],
        paused: "The new picture is now on the screen. The number beside the name is its age.",
        keep([{ age, latencies }]) {
          const last = latencies?.pictures.at(-1);
          if (!age || !last) return null;
          const longest = last.ms.indexOf(Math.max(...last.ms));
          return `To keep: this picture was ${age.shown_ms.toFixed(0)} ms old when it appeared. The longest part was ${latencies.parts[longest].name.replaceAll("_", " ")} with ${last.ms[longest].toFixed(0)} ms.`;
        },
      },
    ],
  },
  race: {
    name: "Race the beam",
    settings: { pipeline: "jitp-scanline-racing", scene: "aircraft", triangles: "30", display: "ntsc", fields: "3600", "head.motion": "sine:20:0.5", "head.tracker": "fastrak", "head.predict": "none" },
    beside: "rendering-control",
    eyes: 1,
    begin: 300,
    steps: [
      {
        title: "A screen is drawn in lines",
        say: "A television screen of that time does not light all of its pixels at once. Sixty times a second, a beam draws lines from the top of the screen to the bottom.",
        until: "line", value: 150, ms: 60, slower: 60, show: ["beam", "alone"],
        paused: "The bright line is the beam. Below the beam, the screen still shows the previous field.",
      },
      {
        title: "Waiting costs time",
        say: "Most machines finish the whole picture before the beam begins to draw it. So the last line is at least one field (17 thousandths of a second) older than necessary.",
        until: "line", value: 420, ms: 60, slower: 60, show: ["beam", "alone"],
        paused: "The beam is now near the bottom of the picture.",
      },
      {
        title: "Just in time",
        say: "In this story, each line is drawn from the newest measurement of the head. The pixels of a line arrive in the memory just before the beam lights them.",
        until: "strip", value: 200, ms: 60, slower: 120, show: ["beam", "regions", "diagram", "alone"],
        paused: "The green frame marks the strip that is copied now. The strip is just ahead of the beam.",
      },
      {
        title: "The race",
        say: "Strip after strip is copied, and the beam follows close behind. A late strip would light with old pixels, so this method needs a scene with few triangles.",
        until: "strip", value: 330, ms: 60, slower: 120, show: ["beam", "regions", "diagram", "alone"],
        paused: "Watch the messages. Small messages travel all the time, instead of whole regions.",
      },
      {
        title: "What is left of the lag",
        say: "Beside it, Rendering Control draws the same scene for the same head. Its gap to the wire frame of the real world is much larger; what is left of the first gap is mostly the delay of the tracker and its cable, which no pipeline can remove.",
        ms: 900, slower: 4, show: ["beam", "wire", "age"],
        paused: "Compare the two ages and the two errors in pixels.",
        keep: ([race, whole]) => (race.age && whole.age ? `To keep: just-in-time pixels are ${race.age.age_ms.toFixed(0)} ms old, and Rendering Control's are ${whole.age.age_ms.toFixed(0)} ms old, in the same instant.` : null),
      },
    ],
  },
  turn: {
    name: "Turn for free",
    settings: { pipeline: "arp-full-line", scene: "gallery", display: "arp", fields: "3600", ...HEAD },
    eyes: 1,
    begin: 500,
    steps: [
      {
        title: "Draw all directions",
        say: "What if the picture did not depend on the direction of the head? Here the machine draws the world in all directions: on the six faces of a cube around the eye.",
        path: rest, ms: 300, slower: 2, show: ["faces"],
        paused: "The six faces are laid out like an unfolded box: left, ahead, right, behind, above and below.",
      },
      {
        title: "Look up the picture of the eye",
        say: "While the beam runs, the display chooses a point on one of the faces for each pixel of your view. The display needs only the direction of the head, and nothing is drawn again.",
        until: "line", value: 240, ms: 60, slower: 60, show: ["faces", "beam"],
        paused: "The display looks up each pixel just before the pixel lights.",
      },
      {
        title: "Turn the head",
        say: "The head turns, and the picture turns at once, although the faces in the memory are older. The wire frame of the real world is much closer to the picture than under Rendering Control.",
        path: swing(18, 2), ms: 1050, slower: 2, show: ["faces", "wire", "age"],
        paused: "The run has stopped in a fast turn. The remaining gap comes from the delay of the tracker, and not from the drawing.",
      },
      {
        title: "What is not free",
        say: "Now the head takes a step of 30 cm to the right. Only turning is free: for another place, the machine must draw the faces again, as slowly as before.",
        path: step(30, 0.4), ms: 480, slower: 4, show: ["faces", "wire", "age"],
        paused: "The run has stopped at the end of the step. The picture is still that of an earlier place.",
      },
      {
        title: "Now you",
        say: "Drag across the picture to turn the head, or move the focus to the picture and use the arrow keys. In the laboratory, choose the pipeline rendering-control and the display ntsc to see the difference.",
        path: swing(12, 4), ms: 600_000, slower: 1, show: ["faces", "wire", "age", "added", "hand"], hand: true,
        paused: "",
        keep: ([{ offset }]) => (offset ? `To keep: ${offset.pixels.toFixed(0)} pixels off at the end of a step of 30 cm. A turn costs only the delay of the tracker.` : null),
      },
    ],
  },
};

/** The moving picture of the first screen. */
export const FIRST_SCREEN = {
  settings: { pipeline: "rendering-control", scene: "gallery", display: "ntsc", fields: "3600", ...HEAD },
  path: swing(14, 3),
  begin: 80,
  show: ["wire", "age", "hand"],
};

/** Returns the story and the step of an address such as `story=lag&step=2`, or null without a story. */
export function storyOf(given) {
  const name = given.get("story");
  if (!Object.hasOwn(STORIES, name ?? "")) return null;
  const step = Math.min(Math.max(1, Math.trunc(Number(given.get("step") ?? 1)) || 1), STORIES[name].steps.length);
  return { name, step: step - 1 };
}

export const inPs = (ms) => Math.round(ms * MS);
