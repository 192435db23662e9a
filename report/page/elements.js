// Makes the elements of the page's controls.
"use strict";
const Elements = (() => {
  const make = (tag, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  };
  // Returns what makes a button at the end of `bar`: its text, its name for those who hear the page, and its act.
  const buttons = (bar) => (text, label, act) => {
    const one = make("button", { type: "button", textContent: text, title: label });
    one.setAttribute("aria-label", label);
    one.addEventListener("click", act);
    bar.append(one);
    return one;
  };
  return { make, buttons };
})();
