% Two rooms, a desk with a monitor in each, and what usually lies around a monitor: the program of two_rooms.qsr.
monitor(m1, r133).
monitor(m2, r200).

0.9::in_front_of(keyboard(M), M) :- monitor(M, _).

0.15::side(cup, K, left); 0.85::side(cup, K, right) :- monitor(M, _), K = keyboard(M), in_front_of(K, M).
left_of(cup, K) :- side(cup, K, left).
right_of(cup, K) :- side(cup, K, right).

0.7::behind_of(bottle, cup, K) :- side(cup, K, _).
0.8::close_to(bottle, cup, K) :- side(cup, K, _).
scene(K) :- right_of(cup, K), behind_of(bottle, cup, K), close_to(bottle, cup, K).

evidence(in_front_of(keyboard(m1), m1)).

query(left_of(cup, keyboard(m1))).
query(right_of(cup, keyboard(m1))).
query(left_of(cup, keyboard(m2))).
query(right_of(cup, keyboard(m2))).
query(scene(keyboard(m1))).
