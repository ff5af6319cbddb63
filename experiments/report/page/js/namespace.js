// All that the scripts of the page share: each file adds its part to this object.
const qddotReport = {};
