// The stories: experiments that run by themselves, stop where something happens, and say in two sentences what it is.

/** To and fro by some degrees, with a period in seconds, from where the head is when it begins. */
const swing = (degrees, period) => (seconds) => [degrees * Math.sin((2 * Math.PI * seconds) / period), 0];
const rest = () => [0, 0];

const HEAD = { "head.motion": "live.csv", "head.tracker": "fastrak", "head.predict": "none" };
const MS = 1e9;

/**
 * Each step has a title and two sentences. It runs `slower` than the machine for `ms` of simulated time, or until something
 * happens (`until`, at most for `ms`; then for `then` more, `thenSlower` than the machine), and says `paused`. `show` names what is drawn besides the
 * pictures. A step without a `path` of the head goes on with that of the step before. With `hand` it waits for the visitor.
 */
export const STORIES = {
  lag: {
    name: "Feel the lag",
    settings: { pipeline: "rendering-control", scene: "gallery", display: "ntsc", fields: "3600", ...HEAD },
    beside: "slats",
    eyes: 1,
    steps: [
      {
        title: "Two pictures of one world",
        say: "The yellow wire frame is the world as it really is at this moment. The picture behind it is what the machine shows you in your headset.",
        path: rest, ms: 700, show: ["wire", "age"],
        paused: "The head is at rest, so picture and world agree.",
      },
      {
        title: "The head turns",
        say: "Now the head swings to the left and to the right. The picture comes after the wire frame: it was drawn for the place where the head was before.",
        path: swing(18, 2), ms: 1050, slower: 2, show: ["wire", "age"],
        paused: "Stopped in the middle of a turn: the gap between the lines and the picture is what you would see as swimming.",
      },
      {
        title: "This is latency",
        say: "The time from measuring the head to the light of the picture is called latency. The numbers under the pictures say how old each picture is, and the older it is, the wider the gap.",
        ms: 320, slower: 6, show: ["wire", "age"],
        paused: "Compare the two ages: the same scene, the same head, the same boards.",
      },
      {
        title: "Where the time goes",
        say: "Rendering Control, the first of the two, draws one eye after the other and hands a picture from stage to stage. Each stage takes its own time, and a finished picture still waits for the screen, which begins anew 60 times a second (a field).",
        ms: 120, slower: 6, show: ["wire", "age", "latency"],
        paused: "Each coloured piece of a bar is one stage, or one wait.",
      },
      {
        title: "What Slats does about it",
        say: "Slats keeps the whole screen in the drawing boards (renderers) at once, so that each triangle is drawn as soon as its place is known. All stages then fit into one field, a sixtieth of a second; the price is that only about 140 triangles fit.",
        ms: 320, slower: 6, show: ["wire", "age", "latency"],
        paused: "The same turn, a smaller gap: the picture of Slats is younger.",
      },
      {
        title: "Now you",
        say: "Drag across a picture to turn the head, or focus it and use the arrow keys. In the laboratory you can change the scene, the pipeline and the tracker of this experiment.",
        path: rest, ms: 600_000, slower: 1, show: ["wire", "age", "latency"], hand: true,
        paused: "",
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
        say: "The machine is a set of computer boards, all plugged into one fast ring. Time runs thousands of times slower here, so that you can see a message travel.",
        ms: 5, slower: 400, show: ["diagram", "regions"],
        paused: "Boards that wait are grey; a board that works says what it does.",
      },
      {
        title: "1. The pose of the head",
        say: "The host reads the tracker and sends the position of the head to the graphics processors. From this moment on the picture is growing old.",
        until: "pose", ms: 200, slower: 60, then: 0.06, thenSlower: 8000, show: ["diagram", "regions", "age"],
        paused: "The host's message is on the ring.",
      },
      {
        title: "2. TRANSFORM",
        say: "Each graphics processor (GP) takes its share of the triangles and works out where they fall on the screen. It sorts them into bins, one for each region of 128 by 128 pixels.",
        until: "transform", ms: 200, slower: 60, then: 0.25, thenSlower: 4000, show: ["diagram", "regions", "age"],
        paused: "The GPs work side by side, while the renderers still hand over the picture before.",
      },
      {
        title: "3. RENDER",
        say: "A renderer has a tiny processor for each of its 16,384 pixels, and all of them obey one command at once. A dashed green frame in the picture marks a region whose triangles are being drawn now.",
        until: "draw", ms: 200, slower: 100, show: ["diagram", "regions", "age"],
        paused: "The renderers draw new regions, while they still hand over the pixels of others.",
      },
      {
        title: "4. COPY",
        say: "Finished pixels go over the ring into the memory of the picture, one region at a time. A yellow frame marks the region that travels now, while renderers already draw others.",
        until: "copy", ms: 200, slower: 100, then: 1.5, thenSlower: 800, show: ["diagram", "regions", "age"],
        paused: "The picture on the screen is still an older one.",
      },
      {
        title: "5. Swap",
        say: "When all regions of both eyes have arrived, the screen changes to the new picture at the start of its next field. Every stage before this one has added to its age.",
        until: "swap", ms: 300, slower: 20, show: ["diagram", "regions", "age", "latency"],
        paused: "The new picture is on the screen, and it is already this old.",
      },
    ],
  },
  race: {
    name: "Race the beam",
    settings: { pipeline: "jitp-scanline", scene: "aircraft", triangles: "30", display: "ntsc", fields: "3600", "head.motion": "sine:20:0.5", "head.tracker": "fastrak", "head.predict": "none" },
    eyes: 1,
    begin: 300,
    steps: [
      {
        title: "A screen is drawn in lines",
        say: "A television screen of that time does not light all at once. A beam draws it line by line from the top, sixty times a second.",
        until: "line", value: 150, ms: 60, slower: 60, show: ["beam"],
        paused: "The bright line is the beam. Lines below it are still of the field before.",
      },
      {
        title: "Waiting costs time",
        say: "A usual machine finishes the whole picture before the beam may start. So the last line is at least one field, 17 thousandths of a second, older than it needs to be.",
        until: "line", value: 420, ms: 60, slower: 60, show: ["beam"],
        paused: "So the bottom of a usual picture is a field older than its top needs to be.",
      },
      {
        title: "Just in time",
        say: "Here each line is drawn for the pose that the head will have when the beam is there. The pixels of a line arrive in the memory just before they light.",
        until: "strip", value: 200, ms: 60, slower: 120, show: ["beam", "regions", "diagram"],
        paused: "The yellow frame marks the strip on its way: it is ahead of the beam.",
      },
      {
        title: "The race",
        say: "Strip after strip is sent while the beam comes down behind it. A strip that is late would light with old pixels, so this needs a scene that is quick to draw.",
        until: "strip", value: 330, ms: 60, slower: 120, show: ["beam", "regions", "diagram"],
        paused: "Watch the messages: small ones, all the time, instead of whole regions.",
      },
      {
        title: "What is left of the lag",
        say: "The head swings, and the gap to the wire frame of the real world is a fraction of the one that Rendering Control leaves. Part of what remains is the delay of the tracker and its cable, which no way of drawing can remove.",
        ms: 900, slower: 4, show: ["beam", "wire", "age"],
        paused: "In the laboratory, choose rendering-control as the one beside it, press Build, and compare.",
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
        say: "What if the machine did not care where you look? Here it draws the world in all directions: six faces of a cube around the eye.",
        path: rest, ms: 300, slower: 2, show: ["faces"],
        paused: "The six faces are laid out like an unfolded box: left, ahead, right, behind, above and below.",
      },
      {
        title: "Look up the eye's picture",
        say: "The display itself decides, while the beam runs, which dot of which face each pixel of your view is. It needs only the direction of the head for that, and no drawing.",
        until: "line", value: 240, ms: 60, slower: 60, show: ["faces", "beam"],
        paused: "The view is looked up while it lights.",
      },
      {
        title: "Turn the head",
        say: "The head turns, and the picture turns at once, although the faces in the memory are older. The wire frame of the real world lies almost on it, much closer than under Rendering Control.",
        path: swing(18, 2), ms: 1050, slower: 2, show: ["faces", "wire"],
        paused: "Stopped in a fast turn: the gap that is left is the delay of the tracker, not of the drawing.",
      },
      {
        title: "What is not free",
        say: "Only turning is free. When the head moves to another place, or when things in the world move, the faces must be drawn again, as slowly as before.",
        ms: 300, slower: 4, show: ["faces", "wire", "diagram"],
        paused: "The boards draw new faces all the time; the display does not wait for them.",
      },
      {
        title: "Now you",
        say: "Drag across the picture to turn the head, or focus it and use the arrow keys. In the laboratory, set the pipeline to rendering-control with the display ntsc to feel the difference.",
        path: rest, ms: 600_000, slower: 1, show: ["faces", "wire"], hand: true,
        paused: "",
      },
    ],
  },
};

/** The picture that moves on the first screen. */
export const FIRST_SCREEN = {
  settings: { pipeline: "slats", scene: "gallery", display: "ntsc", fields: "3600", ...HEAD },
  path: swing(12, 5),
};

/** The story and step that an address names, such as `story=lag&step=2`; null for none. */
export function storyOf(given) {
  const name = given.get("story");
  if (!Object.hasOwn(STORIES, name ?? "")) return null;
  const step = Math.min(Math.max(1, Math.trunc(Number(given.get("step") ?? 1)) || 1), STORIES[name].steps.length);
  return { name, step: step - 1 };
}

export const inPs = (ms) => Math.round(ms * MS);
