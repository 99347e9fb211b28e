#!/usr/bin/env -S octave-cli --quiet --no-init-file
% SPDX-License-Identifier: GPL-3.0-or-later
% A pendulum, u'' = -sin(u), u(0) = 1, u'(0) = 0, to t = 2, by the Runge-Kutta method of order 4.
% usage: pendulum.m STEPS; prints u(2), whose exact value nobody tells, and the change of energy.
steps = str2double(argv(){1});
k = 2/steps;
rate = @(y) [y(2); -sin(y(1))];
energy = @(y) y(2)^2/2 - cos(y(1));
start = y = [1; 0];
for i = 1:steps
    a = rate(y);
    b = rate(y + k/2*a);
    c = rate(y + k/2*b);
    d = rate(y + k*c);
    y += k/6*(a + 2*b + 2*c + d);
end
printf("angle: %.16g rad\n", y(1));
printf("energy: %.6e\n", abs(energy(y) - energy(start)));
